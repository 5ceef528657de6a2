"""Disparity maps and new views of stereo pairs.

    import vantage
    result = vantage.Matcher(disparities=(0, 63)).compute(left, right)
    result.disparity  # float32, HxW, pixels; NaN: unknown

Images are NumPy arrays of uint8, uint16 or float32 (0 to 1), HxW or HxWx3, in RGB order unless
bgr=True, of any strides; where the layout allows they are read in place. Options are those of the
command line, with _ in place of - (surface_fit_step=1). Errors of data are vantage.Error, invalid
options vantage.UsageError, which is a ValueError, too; each is one line. Calls release the GIL and
share one pool of threads; Ctrl-C interrupts them. docs/python.md is a tutorial.
"""

from __future__ import annotations

import atexit as _atexit
import os as _os
import threading as _threading
import weakref as _weakref
from dataclasses import dataclass as _dataclass
from inspect import cleandoc as _cleandoc
from typing import TYPE_CHECKING as _TYPE_CHECKING

import numpy as _np

from vantage import _option_texts, _vantage
from vantage._vantage import (Calibration, Error, MatchResult, Mesh, PointCloud, UsageError,
                              __version__)

__all__ = [
    "Calibration", "Error", "Frame", "MatchResult", "Matcher", "Mesh", "PointCloud",
    "RectifiedImages", "Sequence", "UsageError", "Volume", "cloud", "colours", "depth",
    "depth_resolution", "disparity", "mesh", "read_depth", "read_disparity", "read_image",
    "rectify", "reproject", "synthesize", "write_cloud", "write_depth", "write_disparity",
    "write_image", "write_mesh",
]

if _TYPE_CHECKING:  # at run time they would be names of this module
    import os
    from collections.abc import Iterable, Iterator, Mapping
    from collections.abc import Sequence as _Sequence
    from typing import Any, Literal

    import numpy as np
    from numpy.typing import NDArray

    _Path = str | os.PathLike[str]
    _Image = NDArray[np.uint8] | NDArray[np.uint16] | NDArray[np.float32]
    _Source = _Path | _Sequence[_Image | _Path] | None
    _Pairs = _Path | Iterable[tuple[_Image | _Path, _Image | _Path]] | None
    _Rig = Calibration | _Path | None
    _Map = NDArray[np.float32] | NDArray[np.float64]
    _Mask = NDArray[np.bool_] | NDArray[np.uint8]
    _Numbers = NDArray[Any] | _Sequence[Any]
    _Position = float | tuple[float, float] | Mapping[str, Any]
    _Option = Any  # stands for the type of an option in the stubs, which are made of this file

_loops = _weakref.WeakSet()


class Matcher:
    """Matches rectified pairs, as `vantage match` does.

    preset: "realtime", "balanced" or "quality"; None: "balanced", unless options choose a
    method (method, aggregate, disparities_y).
    disparities: (MIN, MAX) or "MIN:MAX" in pixels, ends included; "auto": estimated for each pair.
    unrectified: Calibration or a path, of photographs that are not rectified: epipolar lines are
    searched instead of rows. Maps are on the pixels of the photographs, disparities those of the
    rectified pair; rectified_pixels=True brings maps to the rectified images, for synthesize() and
    for depth(), cloud() and mesh() of results, which then need no calibration.

    Several threads may use one matcher at a time. Processes get it by its options (pickle).
    """

    def __init__(self, preset: _Option = None, disparities: _Option = "auto", *,
                 unrectified: _Rig = None, rectified_pixels: bool = False, **options: Any) -> None:
        self._set(_calibration_of(unrectified), bool(rectified_pixels),
                  {"preset": preset, "disparities": disparities, **options})

    def _set(self, *given):
        self._given = given
        unrectified, rectified_pixels, options = given
        # Which takes options out.
        self._native = _vantage.Matcher(unrectified, rectified_pixels, dict(options))

    # What a matcher was made of makes it in another process.
    def __getstate__(self):
        return self._given

    def __setstate__(self, given):
        self._set(*given)

    def compute(self, left: _Image, right: _Image, *, more: _Sequence[_Image] = (),
                baselines: _Sequence[float] = (), bgr: bool = False,
                mask: _Mask | Literal["none"] | None = None, mask_right: _Mask | None = None,
                right_disparity: bool = False, confidence: bool = False,
                posterior: bool = False) -> MatchResult:
        """The maps of images of equal size, a MatchResult.

        left, right: arrays of uint8, uint16 or float32 (0 to 1), HxW or HxWx3. Others of fewer
        bits or another scale are brought to it, see the option white_level.
        more, baselines: images of more cameras on the same line, and the positions of the cameras
        of right and of these relative to the first, positive to the right; left is then the
        reference, and disparities are those between left and right.
        bgr: colours are in BGR order.
        mask, mask_right: arrays of bool or uint8, HxW, of left and right: pixels where they are
        False or 0 show no scene; they are neither matched nor filled, and unknown in all results.
        None: black bars of films and black wedges of rectified images are found; "none": all pixels
        show the scene.

        The map of the left image (of the right one with reference="right") is computed now; the
        right one, confidence and posterior mean and variance when they are asked for, or now if
        wanted. Until then the result needs the arrays as they are: it refuses arrays that have
        changed. Raises UsageError for other arrays, Error for images that cannot be matched.
        """
        return self._native.compute(
            left, right, list(more), [float(b) for b in baselines], bool(bgr), mask, mask_right,
            bool(right_disparity), bool(confidence), bool(posterior))

    def volume(self, left: _Image, right: _Image, *,
               kind: Literal["aggregated", "costs"] = "aggregated", level: int = 0,
               rows: tuple[int, int] | None = None, max_bytes: int | None = None,
               more: _Sequence[_Image] = (), baselines: _Sequence[float] = (),
               bgr: bool = False) -> Volume:
        """The disparity space of the map's image, a Volume, as `vantage match --volume` writes it.

        kind: "costs" before aggregation, or "aggregated": what winners are selected from, with
        bayes and the presets but realtime probabilities. level: of the coarse-to-fine search, 0 for
        the full size. rows: (FIRST, LAST), both ends included; None: all. max_bytes: Error for a
        larger array; default half of the machine's memory. Other arguments as of compute().
        """
        options = {"volume_kind": kind, "volume_level": level, "volume_rows": rows,
                   "max_bytes": max_bytes}
        return Volume(*self._native.volume(left, right, list(more),
                                           [float(b) for b in baselines], bool(bgr), options))

    __call__ = compute

    @property
    def options(self) -> dict[str, Any]:
        """All options as a dict; "auto" where preset, method or pair decide."""
        return self._native.options()

    @property
    def threads(self) -> int:
        """Number of threads that calls share."""
        return self._native.threads

    def __repr__(self):
        return repr(self._native)


class Volume:
    """Costs or probabilities of the candidates of each pixel.

    values: float32, HxWxD, or HxWxDyxD of a search with disparities_y; NaN where a candidate has no
    partner or was not searched.
    disparities: float64, D: the candidates in pixels of the full size. disparities_y: int, Dy, or
    None.
    content: "energies" (small: likely) or "probabilities", which sum to 1 where all candidates have
    partners.
    level: of the coarse-to-fine search. first_row: the row of that level that values begin with.
    """

    values: NDArray[np.float32]
    disparities: NDArray[np.float64]
    disparities_y: NDArray[np.int_] | None
    content: str
    level: int
    first_row: int

    def __init__(self, values: NDArray[np.float32], disparities: tuple[int, int], step: float,
                 disparities_y: tuple[int, int] | None, content: str, level: int,
                 first_row: int) -> None:
        self.values = values
        self.disparities = disparities[0] + step * _np.arange(values.shape[-1])
        self.disparities_y = (
            None if disparities_y is None else _np.arange(disparities_y[0], disparities_y[1] + 1))
        self.content = content
        self.level = level
        self.first_row = first_row

    def __repr__(self):
        shape = "x".join(map(str, self.values.shape))
        return f"<vantage.Volume: {self.content}, {shape}>"


@_dataclass(eq=False, repr=False)
class RectifiedImages:
    """What rectify() returns; left, right = rectify(...) takes it apart.

    left, right: arrays as the given ones, whose rows correspond.
    calibration: Calibration of the rectified images, for reproject() and synthesize().
    cameras: Calibration of the given images.
    row_error_px: remaining RMS error of rows if the cameras were estimated, else None.
    valid_region: (x, y, width, height) of the part without black pixels.
    """

    left: NDArray[Any]
    right: NDArray[Any]
    calibration: Calibration
    cameras: Calibration
    row_error_px: float | None
    valid_region: tuple[int, int, int, int]

    def __iter__(self) -> Iterator[NDArray[Any]]:
        return iter((self.left, self.right))


def rectify(left: _Image, right: _Image, calibration: _Rig = None, *, kept_outline: float = 0.0,
            bgr: bool = False, **options: Any) -> RectifiedImages:
    """Rectifies a pair; without a calibration (or the path of one) the cameras are estimated from
    the images, up to scale: the baseline then has length 1.

    Returns RectifiedImages. Raises Error where the images show too little.
    """
    return RectifiedImages(*_vantage.rectify(
        left, right, _calibration_of(calibration), float(kept_outline), bool(bgr), options))


def synthesize(left: _Image, right: _Image,
               view: _Position | list[_Position] | NDArray[Any] | None = None, *,
               disparity: NDArray[np.float32] | None = None,
               right_disparity: NDArray[np.float32] | None = None, calibration: _Rig = None,
               bgr: bool = False, **options: Any) -> Any:
    """New views of a pair, as `vantage synth` makes them: an array like `left`, or a list of them.

    view: a position in baselines (0: left camera, 1: right camera) or (x, y), or a camera as a dict
    of K, R and t, which needs a calibration; a list of these, or an array of positions, gives a
    list. Default 0.5.
    sweep, orbit, pose or path take the place of view. Options of matching count without maps.
    disparity, right_disparity: both maps of the rectified pair; None: they are computed.
    calibration: Calibration or a path; images that are not rectified are rectified first.
    """
    if view is None and not {"sweep", "orbit", "pose", "path"} & options.keys():
        view = 0.5
    if isinstance(view, (_np.ndarray, _np.generic)):  # np.linspace(0, 1, 5), or rows of X, Y
        view = [tuple(one) if isinstance(one, list) else one
                for one in view.tolist()] if view.ndim > 0 else view.item()
    single = view is not None and not isinstance(view, list)
    if view is not None:
        views = [view] if single else view
        if all(isinstance(one, dict) for one in views) and views:
            options["pose"] = views
        else:
            options["view"] = [
                ",".join(str(float(part)) for part in one) if isinstance(one, tuple) else one
                for one in views]
    arrays = _vantage.synthesize(
        left, right, disparity, right_disparity, _calibration_of(calibration), bool(bgr),
        options)
    return arrays[0] if single else arrays


def reproject(disparity: _Map, calibration: Calibration | _Path | _Numbers, *,
              reference: _Option = "left", **options: Any) -> NDArray[np.float32]:
    """Points of a disparity map: float32, HxWx3, in the unit of the calibration.

    X is to the right, Y down and Z ahead of the rectified left camera. NaN where the disparity is
    unknown or at infinity or beyond.

    disparity: float32 or float64, HxW. calibration: Calibration of rectified images (or the path of
    one), or OpenCV's 4x4 matrix Q. reference: "left" or "right", the image of the map. Raises
    UsageError for other arrays and matrices, Error for other calibrations. MatchResult.cloud() makes
    points in metres with their colours.
    """
    if isinstance(calibration, (_np.ndarray, list, tuple)):
        calibration = Calibration.from_depth_matrix(calibration)
    elif calibration is None:
        raise TypeError("calibration is None, expected a Calibration, its path or a matrix Q")
    return _vantage.reproject(disparity, _calibration_of(calibration),
                              {"reference": reference, **options})


def depth(disparity: _Map, calibration: _Rig = None, **options: Any) -> NDArray[np.float32]:
    """Depths of a disparity map in metres: float32, HxW; NaN: unknown, or beyond max_depth.

    disparity: float32 or float64, HxW. calibration: Calibration of rectified images (or the path of
    one). Instead: focal_length with baseline; for one without a scale: baseline or calibration_unit.
    Raises Error for a calibration without a scale. MatchResult.depth() does the same.
    """
    return _vantage.depth(disparity, _calibration_of(calibration), options)


def disparity(depth: _Map, calibration: _Rig = None, **options: Any) -> NDArray[np.float32]:
    """The opposite of depth(); NaN where no depth is known."""
    return _vantage.disparity(depth, _calibration_of(calibration), options)


def depth_resolution(disparity: _Map, calibration: _Rig = None,
                     **options: Any) -> NDArray[np.float32]:
    """Distance from each depth to the next distinguishable one: float32, HxW, in metres,
    or in the calibration's unit where its length is not known. Arguments as of depth().
    """
    return _vantage.depth_resolution(disparity, _calibration_of(calibration), options)


def cloud(disparity: _Map, image: _Image, calibration: _Rig = None, *,
          unmatched: _Mask | None = None, confidence: _Map | None = None, bgr: bool = False,
          **options: Any) -> PointCloud:
    """The pixels of a disparity map as points in metres, a PointCloud, as `vantage reproject` makes
    them. For a MatchResult use its cloud().

    disparity: float32 or float64, HxW. image: the map's image, for colours. unmatched: bool or
    uint8, HxW: filled pixels, which are left out. confidence: float32, HxW, for
    cloud_min_confidence and cloud_confidence. Raises Error where no point is left.
    """
    return _vantage.cloud(disparity, image, _calibration_of(calibration), unmatched, confidence,
                          bool(bgr), options)


def mesh(disparity: _Map, image: _Image, calibration: _Rig = None, *,
         unmatched: _Mask | None = None, confidence: _Map | None = None, bgr: bool = False,
         **options: Any) -> Mesh:
    """The points as a surface of triangles, a Mesh, cut where the disparity jumps. Arguments as of
    cloud(). For a MatchResult use its mesh().
    """
    return _vantage.mesh(disparity, image, _calibration_of(calibration), unmatched, confidence,
                         bool(bgr), options)


@_dataclass(eq=False, repr=False)
class Frame:
    """A frame of a Sequence.

    index, name: of the pair in its source. left, right: arrays, RGB, rectified.
    result: MatchResult; with a calibration or rig of known scale its depth(), cloud() and mesh()
    need no argument, and with poses their points are in the world.
    views, holes, sources: lists with an array for each new view: like left; bool, where no image
    shows it; uint8: 85 from the left image, 170 from the right one, 255 from both, 0 neither.
    stereo: the stereo picture with save=["stereo"], else None.
    share_reused: with reuse the share of the maps taken from the frame before, else None.
    remarks: list of texts.
    """

    index: int
    name: str
    left: NDArray[Any]
    right: NDArray[Any]
    result: MatchResult
    views: list[NDArray[Any]]
    holes: list[NDArray[np.bool_]]
    sources: list[NDArray[np.uint8]]
    stereo: NDArray[Any] | None
    share_reused: float | None
    remarks: list[str]

    @property
    def disparity(self) -> NDArray[np.float32]:
        """That of the result."""
        return self.result.disparity

    def __repr__(self):
        return f"<vantage.Frame {self.index}: {self.name}>"


class Sequence:
    """The frames of a run, matched ahead of the loop that takes them: for frame in Sequence(...).

    Inputs are those of `vantage run`: left and right, with more and baselines; or one of stereo,
    pairs and sequence. preset, disparities: as of Matcher; "auto" is the range of all frames.
    save: what to compute of each frame, by the names of `vantage run --save`; default the maps of
    the reference, and the views if there are any. Other maps are computed when they are asked for,
    unless they depend on other frames.
    frames: range or slice of the pairs to go through, increasing, or "A-B" or "A-B:N" as for run;
    default all.
    calibration: Calibration or a path, to rectify the pairs first. unrectified, rectified_pixels:
    instead, as for Matcher.

    pairs: the path of a list, or an iterable of (left, right), each an array or the path of an
    image: a camera, a queue, a generator. A thread of its own goes through it and copies the
    images: in_flight pairs are in work or done, as many wait; exceptions of it are raised here,
    after the frames before it. Rows and disparities="auto" are found in the first pair. Values "shot" and frames are
    refused. left and right may be lists of images, too. len() is that of the iterable, or a
    TypeError.
    live: of an iterable: one frame in flight, always of the newest pair; those that came meanwhile
    are dropped, and dropped is their number after a loop.
    bgr: arrays that are given and those of frames have this order instead of RGB.

    Maps are those that `vantage run` writes. Frames are read, matched and rendered in other threads
    while the loop works. Leaving the loop, an exception in it or Ctrl-C ends them. Iterating starts
    at the first frame each time. Raises Error at the first bad frame, after all frames before it;
    with keep_going it is left out.

    After a loop, skipped is a list of (index, reason) of the frames left out.
    """

    skipped: list[tuple[int, str]]
    dropped: int

    def __init__(self, left: _Source = None, right: _Source = None, *, pairs: _Pairs = None,
                 frames: range | slice | str | None = None, calibration: _Rig = None,
                 unrectified: _Rig = None, rectified_pixels: bool = False, preset: _Option = None,
                 disparities: _Option = "auto", save: _Option = None,
                 live: bool = False, bgr: bool = False, **options: Any) -> None:
        self._supplied = _supplied_pairs(left, right, pairs)
        if self._supplied is not None:
            left = right = pairs = None
            if frames is not None:
                raise UsageError("frames is given, but pairs are an iterable, expected "
                                 "itertools.islice of it")
        if save is not None:
            names = save.split(",") if isinstance(save, str) else save
            options["save"] = [name.replace("_", "-") for name in names]
        if isinstance(frames, str):
            options["frames"] = frames
        if calibration is not None and unrectified is not None:
            raise UsageError("calibration and unrectified are both given, expected one of them")
        self._native = _vantage.Sequence(
            _calibration_of(calibration if unrectified is None else unrectified,
                            [side for side in (left, right) if side is not None]),
            unrectified is not None, self._supplied is not None, bool(bgr),
            {"left": left, "right": right, "pairs": pairs, "preset": preset,
             "disparities": disparities, "rectified_pixels": rectified_pixels or None,
             "live": live or None, **options})
        self._bgr = bool(bgr)
        self._frames = self._supplied if self._supplied is not None else self._chosen(frames)
        self.skipped = []
        self.dropped = 0

    def _chosen(self, frames):
        count = len(self._native)
        if frames is None or isinstance(frames, str):
            return range(*self._native.selected())
        if not isinstance(frames, (slice, range)):
            raise UsageError(f"frames is {frames!r}, expected a range or a slice")
        chosen = range(count)[frames] if isinstance(frames, slice) else frames
        if chosen and not (0 <= min(chosen) and max(chosen) < count):
            raise UsageError(f"frames is {frames!r}, expected numbers from 0 to {count - 1}")
        if chosen.step < 0:
            raise UsageError(f"frames is {frames!r}, expected increasing numbers")
        return chosen

    def __len__(self) -> int:
        return len(self._frames)

    def __bool__(self) -> bool:
        return not hasattr(self._frames, "__len__") or len(self._frames) > 0

    def __repr__(self):
        known = hasattr(self._frames, "__len__")
        return f"<vantage.Sequence: {len(self) if known else 'unknown number of'} frames>"

    def __iter__(self) -> Iterator[Frame]:
        if self._supplied is None:
            yield from self._frames_of(self._native.loop(list(self._frames)))
            return
        feed = self._native.feed()
        problems = []
        puller = _threading.Thread(target=_pull, name="vantage pairs", daemon=True,
                                   args=(iter(self._supplied), feed, self._bgr, problems))
        puller.start()
        try:
            loop = self._native.loop_over(feed)  # waits for the first pair
            if loop is not None:
                yield from self._frames_of(loop)
        finally:
            feed.close()
            puller.join(1)  # it may wait in the iterable, which then ends later or never
        if problems:
            raise problems[0]

    def _frames_of(self, loop):
        _loops.add(loop)
        try:
            while (found := loop.next()) is not None:
                yield Frame(**found)
        finally:
            loop.close()
            self.skipped = loop.skipped()
            self.dropped = loop.dropped()


def _is_path(value):
    return isinstance(value, (str, bytes, _os.PathLike))


def _supplied_pairs(left, right, pairs):
    """The iterable of pairs; None where inputs are files."""
    sides = {name: side for name, side in [("left", left), ("right", right)] if side is not None}
    if pairs is not None and not _is_path(pairs):
        if sides:
            raise UsageError(f"pairs and {next(iter(sides))} are given, expected one of them")
        is_iterable = hasattr(pairs, "__iter__") or hasattr(pairs, "__getitem__")
        if not is_iterable or isinstance(pairs, _np.ndarray):
            raise TypeError(f"pairs is of type {type(pairs).__name__}, expected a path or an "
                            "iterable of (left, right)")
        return pairs
    for name, side in sides.items():
        if not _is_path(side) and not isinstance(side, (list, tuple)):
            raise TypeError(f"{name} is of type {type(side).__name__}, expected a path or a list "
                            "of images (a single pair: Matcher.compute)")
    if all(_is_path(side) for side in sides.values()):
        return None
    if pairs is not None or len(sides) != 2 or any(_is_path(side) for side in sides.values()):
        raise UsageError("a list of images is given, expected one for left and one for right")
    if len(left) != len(right):
        raise UsageError(f"left has {len(left)} images but right {len(right)}, expected as many")
    return list(zip(left, right))


def _pull(pairs, feed, bgr, problems):
    """The work of the thread that goes through an iterable of pairs."""
    try:
        for number, pair in enumerate(pairs):
            if not isinstance(pair, (tuple, list)) or len(pair) != 2:
                raise TypeError(f"pair {number} is of type {type(pair).__name__}, expected "
                                "(left, right)")
            if not feed.put(*(read_image(side, bgr=bgr) if _is_path(side) else side
                              for side in pair)):
                break
    except BaseException as problem:  # raised by the loop
        problems.append(problem)
    finally:
        feed.end()


@_atexit.register
def _end_loops():
    """Threads of loops that nobody has left must not outlive what they use."""
    for loop in list(_loops):
        loop.close()


def read_image(path: _Path, *, bgr: bool = False, **options: Any) -> NDArray[Any]:
    """Reads PNG, JPEG, TIFF, JPEG 2000, PNM, BMP, WebP, EXR or PFM: uint8, uint16 or float32.

    "scan.tif#2" is page 2 of a TIFF, "photo.mpo#1" the right view of an MPO or JPS, counted from 0.
    Floats are NaN where the file has no data.
    """
    return _vantage.read_image(path, bool(bgr), options)


def write_image(path: _Path, image: _Image, *, bgr: bool = False) -> None:
    """Writes an image; the extension is the format."""
    _vantage.write_image(path, image, bool(bgr))


def read_disparity(path: _Path, scale: float = 0.0) -> NDArray[np.float32]:
    """Reads a disparity map (PFM, PNG, TIFF, EXR, NPY): float32, NaN where it is unknown.

    scale divides the values of integer files; 0: 256 for 16-bit PNG. 16 is that of OpenCV's
    matchers, whose (minDisparity - 1) is unknown. What was assumed is a warning.
    """
    return _vantage.read_disparity(path, float(scale))


def read_depth(path: _Path, scale: float = 0.0) -> NDArray[np.float32]:
    """Reads a depth map of the same formats: float32, metres, NaN unknown. scale: values per metre;
    0: 1000 for integers, 1 for floats, with a warning. disparity() makes a disparity map of it."""
    return _vantage.read_depth(path, float(scale))


def write_disparity(path: _Path, disparity: _Map) -> None:
    """Writes a disparity map; the extension is the format: .pfm .png .tiff .exr .npy."""
    _vantage.write_disparity(path, disparity)


def write_depth(path: _Path, depth: _Map) -> None:
    """Writes depths in metres, float32 or float64, HxW, NaN unknown; the extension is the format:
    .png in millimetres (16 bits, 0 unknown, also beyond 65.535 m), .pfm .tiff .exr .npy in metres.
    """
    _vantage.write_depth(path, depth)


def write_cloud(path: _Path, cloud: PointCloud) -> None:
    """Writes a PointCloud as a binary PLY file."""
    _require_type("cloud", cloud, PointCloud)
    _vantage.write_cloud(path, cloud)


def write_mesh(path: _Path, mesh: Mesh) -> None:
    """Writes a Mesh as a binary PLY file."""
    _require_type("mesh", mesh, Mesh)
    _vantage.write_mesh(path, mesh)


def colours(disparity: _Map, limits: tuple[float, float] | None = None) -> NDArray[np.uint8]:
    """The map in false colours (Turbo; unknown is black): uint8, HxWx3, RGB.

    limits: disparities of the first and the last colour; default: from the map.
    """
    return _vantage.colours(disparity, limits)


for _name, _text in _option_texts.TEXTS.items():
    globals()[_name].__doc__ = f"{_cleandoc(globals()[_name].__doc__)}\n\n{_text}\n"


def _require_type(name, value, expected):
    if not isinstance(value, expected):
        raise TypeError(
            f"{name} is of type {type(value).__name__}, expected a {expected.__name__}")


def _calibration_of(calibration, images=()):
    if calibration is None or isinstance(calibration, Calibration):
        return calibration
    return Calibration.load(calibration, images=images)
