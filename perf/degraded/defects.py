"""What happens to photographs on their way to a user: noise, codecs, rows, light, bits, sky.

A defect takes a clean `Pair` and a random generator and returns another pair; where it crops, the
truth is cropped too.
"""

import subprocess
from dataclasses import replace

import cv2
import numpy as np


def unchanged(pair, _):
    """The clean pair; and a JPEG, which loses what it loses when its file is written."""
    return pair


def levels(image):
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def both(change):
    return lambda pair, random: replace(pair, left=change(pair.left, random),
                                        right=change(pair.right, random))


def right_only(change):
    return lambda pair, random: replace(pair, right=change(pair.right, random))


def with_noise(image, random, sigma):
    return levels(image + random.normal(0, sigma, image.shape))


def noise(sigma):
    return both(lambda image, random: with_noise(image, random, sigma))


def few_photons(image, random):
    return levels(random.poisson(image / 255 * 40) / 40 * 255 * 0.25)


def vignette(image, _):
    height, width = image.shape[:2]
    y, x = np.mgrid[:height, :width]
    radius2 = ((x - 0.3 * width) ** 2 + (y - 0.5 * height) ** 2) / (0.5 * width * width)
    return levels(image * (1 - 0.6 * radius2)[..., None])


def lowered_image(image, rows, turned_rows=0.0):
    """Lower by `rows`, and by `turned_rows` more at the right border than at the left one. Columns
    stay, so that the truth does."""
    width = image.shape[1]
    slope = turned_rows / width
    shift = np.float32([[1, 0, 0], [slope, 1, rows - slope * width / 2]])
    return cv2.warpAffine(image, shift, image.shape[1::-1], flags=cv2.INTER_CUBIC,
                          borderMode=cv2.BORDER_REPLICATE)


def lowered(rows, turned_rows=0.0):
    return right_only(lambda image, _: lowered_image(image, rows, turned_rows))


FRAMES, PAN_X, PAN_Y = 9, 3, 1


def film(encoder, crf, frame=lambda left, right, random: (left, right)):
    """The middle frame of a film, both images side by side: a crop that moves by (3, 1) px from
    frame to frame over the pair, nine frames, coded as 4:2:0 by FFmpeg at the rate factor `crf`.
    `frame` changes every frame before it is coded."""
    def change(pair, random):
        height, width = pair.truth_px.shape
        width = (width - (FRAMES - 1) * PAN_X) // 8 * 8
        height = (height - (FRAMES - 1) * PAN_Y) // 2 * 2
        def crop(image, index):
            return image[index * PAN_Y:index * PAN_Y + height, index * PAN_X:index * PAN_X + width]
        frames = (np.hstack(frame(crop(pair.left, i), crop(pair.right, i), random)).tobytes()
                  for i in range(FRAMES))
        size = ["-f", "rawvideo", "-pix_fmt", "bgr24", "-s", f"{2 * width}x{height}"]
        quiet = ["ffmpeg", "-loglevel", "error"]
        muxer = {"libx264": "h264", "libx265": "hevc"}[encoder]
        coded = subprocess.run([*quiet, *size, "-i", "-", "-c:v", encoder, "-crf", str(crf),
                                "-pix_fmt", "yuv420p", "-threads", "1", "-f", muxer, "-"],
                               input=b"".join(frames), stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, check=True).stdout
        decoded = subprocess.run([*quiet, "-f", muxer, "-i", "-", "-f", "rawvideo", "-pix_fmt",
                                  "bgr24", "-"], input=coded, stdout=subprocess.PIPE, check=True)
        images = np.frombuffer(decoded.stdout, np.uint8).reshape(FRAMES, height, 2 * width, 3)
        middle = FRAMES // 2
        return replace(pair, left=images[middle][:, :width], right=images[middle][:, width:],
                       truth_px=crop(pair.truth_px, middle), judged=crop(pair.judged, middle))
    return change


def all_at_once(left, right, random):
    """Darker, lower, and noisy, before it is coded."""
    right = lowered_image(0.93 * right.astype(np.float32), 0.4)
    return with_noise(left, random, 3), with_noise(right, random, 3)


def sky(pair, random):
    """A smooth sky with noise of 2 grey levels over the upper third, where nothing is judged."""
    height, width = pair.truth_px.shape
    rows = height // 3
    y = np.linspace(0, 1, rows)[:, None, None]
    smooth = np.tile((1 - y) * [220, 170, 130] + y * [235, 215, 200], (1, width, 1))
    def below(image):
        return np.vstack([with_noise(smooth, random, 2), image[rows:]])
    truth_px, judged = pair.truth_px.copy(), pair.judged.copy()
    truth_px[:rows], judged[:rows] = np.nan, False
    return replace(pair, left=below(pair.left), right=below(pair.right), truth_px=truth_px,
                   judged=judged)


def twelve_bits(image, _):
    return np.rint(image * (4095 / 255)).astype(np.uint16)


FILMS = {
    "H.264 CRF 18": film("libx264", 18),
    "H.264 CRF 23": film("libx264", 23),
    "H.264 CRF 28": film("libx264", 28),
    "HEVC CRF 18": film("libx265", 18),
    "HEVC CRF 23": film("libx265", 23),
    "HEVC CRF 28": film("libx265", 28),
    "mixed": film("libx264", 23, all_at_once),
}
# The defects of docs/QUALITY.md.
FIELD = {
    "clean": unchanged,
    "JPEG 75": unchanged,
    **FILMS,
    "noise of 5": noise(5),
    "noise of 12": noise(12),
    "0.5 rows lower": lowered(0.5),
    "1 row lower": lowered(1),
    "1.5 rows lower": lowered(1.5),
    "turned by 3 rows": lowered(0, 3),
    "darker": right_only(lambda image, _: levels(0.7 * image)),
    "vignette": right_only(vignette),
    "blurred": right_only(lambda image, _: cv2.GaussianBlur(image, (0, 0), 1.2)),
    "sky": sky,
    "12 of 16 bits": both(twelve_bits),
}
DEFECTS = FIELD | {
    "noise of 2": noise(2),
    "few photons": both(few_photons),
    "gamma 1.5": right_only(lambda image, _: levels(255 * (image / 255) ** 1.5)),
    "other colours": right_only(lambda image, _: levels(image * np.float32([0.7, 1, 1.3]))),
    "both blurred": both(lambda image, _: cv2.GaussianBlur(image, (0, 0), 2.5)),
    "JPEG 90": unchanged,
    "JPEG 50": unchanged,
    "0.3 rows lower": lowered(0.3),
    "0.7 rows lower": lowered(0.7),
}
