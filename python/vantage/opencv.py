"""StereoVantage has the interface of cv2.StereoSGBM, for scripts that are written for it.

    stereo = vantage.opencv.StereoVantage_create(minDisparity=0, numDisparities=64)
    disparity = stereo.compute(left, right)  # int16, 16 steps per pixel
"""

import numpy as _np

import vantage as _vantage

DISP_SHIFT = 4
DISP_SCALE = 16


class StereoVantage:
    """Matches 8-bit pairs as cv2 reads them: grey, or colours in BGR order.

    minDisparity, numDisparities: the range to search, minDisparity to
    minDisparity + numDisparities - 1. What else StereoSGBM_create() takes (blockSize, P1, P2, …)
    is accepted and has no effect. preset and other options are those of vantage.Matcher; fill is
    "none" unless given: pixels without a match stay unknown, as in OpenCV.
    """

    def __init__(self, minDisparity=0, numDisparities=64, blockSize=None, P1=None, P2=None,
                 disp12MaxDiff=None, preFilterCap=None, uniquenessRatio=None,
                 speckleWindowSize=None, speckleRange=None, mode=None, *, preset="balanced",
                 **options):
        self._options = {"fill": "none", **options, "preset": preset}
        self._range = (int(minDisparity), int(numDisparities))
        self._matcher = None
        self._update()

    @staticmethod
    def create(*arguments, **options):
        """As StereoSGBM.create()."""
        return StereoVantage(*arguments, **options)

    def _update(self):
        first, count = self._range
        # int16 holds 16 times the disparity.
        if count < 1 or abs(first) + count > 2000:
            raise _vantage.UsageError(
                f"minDisparity is {first} and numDisparities is {count}, expected at least 1 "
                "disparity, and all within 2000 pixels")
        self._matcher = _vantage.Matcher(disparities=(first, first + count - 1), **self._options)

    def compute(self, left, right, disparity=None):
        """int16, HxW: 16 times the disparity, (minDisparity - 1) * 16 where it is unknown."""
        map_px = self._matcher.compute(left, right, bgr=True).disparity
        unknown = (self._range[0] - 1) * DISP_SCALE
        with _np.errstate(invalid="ignore"):
            fixed = _np.where(_np.isfinite(map_px), _np.rint(map_px * DISP_SCALE), unknown)
        fixed = fixed.astype(_np.int16)
        if disparity is None:
            return fixed
        disparity[...] = fixed
        return disparity

    def getMinDisparity(self):
        """The smallest disparity, in pixels."""
        return self._range[0]

    def setMinDisparity(self, minDisparity):
        """Moves the range."""
        self._range = (int(minDisparity), self._range[1])
        self._update()

    def getNumDisparities(self):
        """The number of disparities."""
        return self._range[1]

    def setNumDisparities(self, numDisparities):
        """Changes it; any number of at least 1."""
        self._range = (self._range[0], int(numDisparities))
        self._update()


def StereoVantage_create(*arguments, **options):
    """As cv2.StereoSGBM_create()."""
    return StereoVantage(*arguments, **options)
