"""StereoSGBM in the settings of perf/quality, and with block 9; colour and grey."""

import cv2
import numpy as np

# Mode, uniqueness in percent; blocks; channels that are compared.
MODES = {"SGBM": (cv2.STEREO_SGBM_MODE_SGBM, 0), "three-way": (cv2.STEREO_SGBM_MODE_SGBM_3WAY, 0),
         "HH": (cv2.STEREO_SGBM_MODE_HH, 10)}
PEERS = {f"{mode} {block}{' grey' if channels == 1 else ''}": (*MODES[mode], block, channels)
         for mode in MODES for block in (3, 5, 9) for channels in (3, 1)}


def eight_bits(image):
    """What a user of OpenCV makes of 16-bit files with 12 significant bits."""
    return image if image.dtype == np.uint8 else (image / 16 + 0.5).clip(0, 255).astype(np.uint8)


def row_filled(disparity):
    """Pixels without a match take the smaller disparity of the matches beside them."""
    from_left, from_right = disparity.copy(), disparity.copy()
    for x in range(1, disparity.shape[1]):
        for filled, at, beside in ((from_left, x, x - 1), (from_right, -1 - x, -x)):
            unknown = np.isnan(filled[:, at])
            filled[unknown, at] = filled[unknown, beside]
    return np.fmin(from_left, from_right)


def peer_map(peer, left, right, candidates):
    """The left map: padded border, cross-check of 1 px, speckles of 100 px, filled."""
    mode, uniqueness_percent, block, channels = PEERS[peer]
    left, right = eight_bits(left), eight_bits(right)
    if channels == 1:
        left, right = (cv2.cvtColor(image, cv2.COLOR_BGR2GRAY) for image in (left, right))
    left, right = (cv2.copyMakeBorder(image, 0, 0, candidates, 0, cv2.BORDER_REPLICATE)
                   for image in (left, right))
    penalty = 8 * channels * block * block
    matcher = cv2.StereoSGBM_create(0, candidates, block, P1=penalty, P2=4 * penalty, mode=mode,
                                    disp12MaxDiff=1, uniquenessRatio=uniqueness_percent,
                                    speckleWindowSize=100, speckleRange=1, preFilterCap=63)
    disparity = matcher.compute(left, right)[:, candidates:] / np.float32(16)
    disparity[disparity < 0] = np.nan
    return row_filled(disparity)
