"""StereoVantage has the interface of cv2.StereoSGBM, for scripts that are written for it.

    stereo = vantage.opencv.StereoVantage_create(minDisparity=0, numDisparities=64)
    disparity = stereo.compute(left, right)  # int16, 16 steps per pixel
"""

import operator as _operator
import sys as _sys
import warnings as _warnings

import numpy as _np

import vantage as _vantage

DISP_SHIFT = 4
DISP_SCALE = 16

# Parameters of StereoSGBM's own method, and their values that ask for nothing else than what is
# done here.
_IDLE = {"blockSize": (3,), "P1": (0,), "P2": (0,), "preFilterCap": (0,), "uniquenessRatio": (0,),
         "speckleRange": (0, 1), "mode": (0,)}
# The options of Matcher that parameters set.
_OPTION_OF = {"disp12MaxDiff": "cross_check", "speckleWindowSize": "speckle_size"}


class StereoVantage:
    """Matches 8-bit pairs as cv2 reads them: grey, or colours in BGR order.

    The parameters, their order and their defaults are those of cv2.StereoSGBM_create().

    minDisparity, numDisparities: the range to search, minDisparity to
    minDisparity + numDisparities - 1; any number of at least 1.
    disp12MaxDiff: pixels whose left and right disparities differ by more are unknown; up to 0: the
    check of the preset, as OpenCV then has its own.
    speckleWindowSize: largest region that counts as a speckle and is unknown; up to 0: that of the
    preset (the option speckle_size=0 switches it off). Regions are connected where neighbours
    differ by at most 1 pixel, as with speckleRange=1.
    blockSize, P1, P2, preFilterCap, uniquenessRatio, other values of speckleRange, and mode belong
    to the method of StereoSGBM. They are kept and have no effect; a warning says so.

    preset and other options are those of vantage.Matcher; fill is "none" unless given: pixels
    without a match stay unknown, as in OpenCV.
    """

    def __init__(self, minDisparity=0, numDisparities=16, blockSize=3, P1=0, P2=0,
                 disp12MaxDiff=0, preFilterCap=0, uniquenessRatio=0, speckleWindowSize=0,
                 speckleRange=0, mode=0, *, preset=None, **options):
        self._options = {"fill": "none", **options, "preset": preset}
        self._values = {}
        self._told = set()
        self._set(minDisparity=minDisparity, numDisparities=numDisparities, blockSize=blockSize,
                  P1=P1, P2=P2, disp12MaxDiff=disp12MaxDiff, preFilterCap=preFilterCap,
                  uniquenessRatio=uniquenessRatio, speckleWindowSize=speckleWindowSize,
                  speckleRange=speckleRange, mode=mode)

    @staticmethod
    def create(*arguments, **options):
        """As StereoSGBM.create()."""
        return StereoVantage(*arguments, **options)

    def _set(self, **changes):
        """Takes all changes or, with an exception, none."""
        values = {**self._values, **{name: _integer(name, changes[name]) for name in changes}}
        self._matcher = _matcher_of(values, self._options)
        self._values = values
        idle = [name for name in changes
                if name in _IDLE and values[name] not in _IDLE[name] and name not in self._told]
        if idle:
            self._told.update(idle)
            _warnings.warn(f"StereoVantage: without effect: {', '.join(idle)}; see "
                           "help(vantage.opencv.StereoVantage)", stacklevel=_level_of_caller())

    def compute(self, left, right, disparity=None):
        """int16, HxW: 16 times the disparity, (minDisparity - 1) * 16 where it is unknown.

        disparity: an int16 array of the size of the images takes the result; otherwise it is a new
        array, as in OpenCV.
        """
        map_px = self._matcher.compute(left, right, bgr=True).disparity
        unknown = (self._values["minDisparity"] - 1) * DISP_SCALE
        with _np.errstate(invalid="ignore"):
            fixed = _np.where(_np.isfinite(map_px), _np.rint(map_px * DISP_SCALE), unknown)
        fixed = fixed.astype(_np.int16)
        if (isinstance(disparity, _np.ndarray) and disparity.dtype == _np.int16
                and disparity.shape == fixed.shape):
            disparity[...] = fixed
            return disparity
        return fixed

    def __repr__(self):
        return (f"<vantage.opencv.StereoVantage: minDisparity {self.getMinDisparity()}, "
                f"numDisparities {self.getNumDisparities()}>")


# What get…() and set…() of each parameter say.
_PARAMETERS = {
    "minDisparity": ("The smallest disparity, in pixels.", "Moves the range."),
    "numDisparities": ("The number of disparities.", "Changes it; any number of at least 1."),
    "disp12MaxDiff": ("The difference of left and right disparities that is accepted.",
                      "Changes it, in whole pixels; up to 0: the check of the preset."),
    "speckleWindowSize": ("The size of the largest speckle.",
                          "Changes it, in pixels; up to 0: that of the preset."),
    "speckleRange": ("The given value; speckles are always those of 1.",
                     "Without effect: speckles are always those of 1."),
    "uniquenessRatio": ("The given value.", "Without effect; the option confidence_threshold "
                                            "discards doubtful matches."),
    "mode": ("The given value.", "Without effect; presets take its place."),
    **dict.fromkeys(("blockSize", "P1", "P2", "preFilterCap"),
                    ("The given value.", "Without effect."))}


def _add_accessors(name, of_get, of_set):
    def get(self):
        return self._values[name]

    def set(self, value):
        self._set(**{name: value})

    for prefix, function, text in [("get", get, of_get), ("set", set, of_set)]:
        function.__name__ = prefix + name[0].upper() + name[1:]
        function.__qualname__ = f"StereoVantage.{function.__name__}"
        function.__doc__ = text
        setattr(StereoVantage, function.__name__, function)


for _name, _texts in _PARAMETERS.items():
    _add_accessors(_name, *_texts)


def StereoVantage_create(*arguments, **options):
    """As cv2.StereoSGBM_create()."""
    return StereoVantage(*arguments, **options)


def _integer(name, value):
    try:
        return _operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}, expected a whole number") from None


def _matcher_of(values, options):
    first, count = values["minDisparity"], values["numDisparities"]
    # int16 holds 16 times the disparity.
    if count < 1 or abs(first) + count > 2000:
        raise _vantage.UsageError(
            f"minDisparity is {first} and numDisparities is {count}, expected at least 1 "
            "disparity, and all within 2000 pixels")
    options = dict(options)
    for name, option in _OPTION_OF.items():
        if values[name] > 0:
            if options.get(option) is not None:
                raise _vantage.UsageError(
                    f"{name} and {option} are both given, expected one of them")
            # Both options are the first value that is refused, not the last that is accepted.
            options[option] = values[name] + 1
    return _vantage.Matcher(disparities=(first, first + count - 1), **options)


def _level_of_caller():
    """For warnings: the first line outside of this file."""
    level = 1
    while _sys._getframe(level).f_code.co_filename == __file__:
        level += 1
    return level
