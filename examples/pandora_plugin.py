"""Vantage as the disparity step of pandora (CNES), and so of CARS, which matches with pandora.

    "disparity": {"disparity_method": "vantage", "invalid_disparity": "NaN", "preset": "quality"}

Other keys are options of vantage.Matcher, and "band" where images have several. Only the range of
the cost volume is used, so a cheap one will do. Maps have fractions of pixels and need no
refinement.
"""

import math

import numpy as np
import xarray as xr

import vantage

try:
    from pandora.disparity.disparity import AbstractDisparity
except ImportError:  # the functions need no pandora
    AbstractDisparity = None

# Bits of a validity mask.
NO_DATA_LEFT, NO_PARTNER, CUT_RANGE, FILLED, MASKED_LEFT, MISMATCH = (1 << bit for bit in
                                                                      (0, 1, 2, 5, 6, 9))


def pixels_of(image, band):
    """The band `band` of an image of pandora, HxW."""
    pixels = image["im"]
    if "band_im" in pixels.dims:
        if band is None:
            raise ValueError(f"images have the bands {list(pixels.band_im.values)}, expected band")
        pixels = pixels.sel(band_im=band)
    return np.ascontiguousarray(pixels.values, np.float32)


def masks_of(image, pixels):
    """Where an image of pandora has no data, and where it shows what is not to be matched: HxW."""
    no_data = np.isnan(pixels) | (pixels == image.attrs.get("no_data_img", np.nan))
    if "msk" not in image:
        return no_data, np.zeros_like(no_data)
    mask = image["msk"].values
    no_data |= mask == image.attrs["no_data_mask"]
    return no_data, (mask != image.attrs["valid_pixels"]) & ~no_data


def validity_mask(result, no_data, masked, first, last):
    """Why pixels are invalid, and what was made up: uint16, HxW."""
    bits = np.zeros(no_data.shape, np.uint16)
    columns = np.arange(no_data.shape[1])
    end = columns[-1]
    bits[:, (columns + first < 0) | (columns + last > end)] |= CUT_RANGE
    bits[:, (columns + last < 0) | (columns + first > end)] |= NO_PARTNER
    is_unknown = np.isnan(result.disparity)
    bits[no_data] |= NO_DATA_LEFT
    bits[masked] |= MASKED_LEFT
    bits[is_unknown & ~no_data & ~masked & (bits & NO_PARTNER == 0)] |= MISMATCH
    bits[~is_unknown & result.unmatched] |= FILLED
    return bits


def disparity_dataset(cv, left, right, invalid_disparity=math.nan, band=None, **options):
    """The dataset of a disparity step: d = x_right - x_left of `left`, in the range of `cv`.

    options: of vantage.Matcher; fill is "none" unless they say otherwise.
    """
    first, last = math.floor(float(cv.disp.min())), math.ceil(float(cv.disp.max()))
    matcher = vantage.Matcher(**{"fill": "none", **options}, disparities=(-last, -first))
    images = [pixels_of(image, band) for image in (left, right)]
    masks = [masks_of(image, pixels) for image, pixels in zip((left, right), images)]
    for pixels, (no_data, _) in zip(images, masks):
        pixels[no_data] = np.nan
    show_scene = [~(no_data | masked) for no_data, masked in masks]
    result = matcher.compute(*images, mask=show_scene[0], mask_right=show_scene[1], confidence=True)

    bits = validity_mask(result, *masks[0], first, last)
    disparity = np.where(np.isnan(result.disparity), invalid_disparity, -result.disparity)
    confidence = xr.DataArray(result.confidence[..., None], dims=["row", "col", "indicator"],
                              coords={"indicator": ["confidence_from_vantage"]})
    if "confidence_measure" in cv:
        confidence = xr.concat([cv.confidence_measure.drop_vars(["row", "col"]), confidence],
                               dim="indicator")
    return xr.Dataset({"disparity_map": (["row", "col"], disparity.astype(np.float32)),
                       "validity_mask": (["row", "col"], bits), "confidence_measure": confidence},
                      coords={"row": left.row, "col": left.col}, attrs=dict(cv.attrs))


if AbstractDisparity is not None:
    @AbstractDisparity.register_subclass("vantage")
    class VantageDisparity(AbstractDisparity):
        """The disparity step "vantage"."""

        def __init__(self, **cfg):
            self.cfg = self.check_conf(**cfg)

        def check_conf(self, **cfg):
            """`cfg` with defaults; raises vantage.UsageError for options that there are not."""
            cfg = {"invalid_disparity": -9999, **cfg}
            vantage.Matcher(**self.options_of(cfg))
            return cfg

        @staticmethod
        def options_of(cfg):
            return {name: value for name, value in cfg.items()
                    if name not in ("disparity_method", "invalid_disparity", "band")}

        def desc(self):
            print("Vantage disparity method")

        def to_disp(self, cv, img_left=None, img_right=None):
            return disparity_dataset(cv, img_left, img_right, float(self.cfg["invalid_disparity"]),
                                     self.cfg.get("band"), **self.options_of(self.cfg))
