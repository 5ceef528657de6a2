"""Scenes with truth, and which of their pixels are judged."""

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

# Left and right image, truth of the left one, its values per pixel of disparity, candidates.
SCENES = {
    "cones": ("im2.png", "im6.png", "disp2.png", 4, 64),
    "motorcycle": ("im0.png", "im1.png", "disp0.pfm", 1, 72),
    "art": ("view1.png", "view5.png", "disp1.png", 2, 128),
    "baby1": ("view1.png", "view5.png", "disp1.png", 2, 80),
    "cloth1": ("view1.png", "view5.png", "disp1.png", 2, 96),
    "aloe": ("view1.png", "view5.png", "disp1.png", 2, 112),
    "bowling1": ("view1.png", "view5.png", "disp1.png", 2, 128),
    "venus": ("im2.ppm", "im6.ppm", "disp2.pgm", 8, 32),
    "kitti2015_000045": ("left.png", "right.png", "disp_noc_0.png", 256, 96),
    "flyingthings_a0032": ("left.png", "right.png", "disp_left.pfm", 1, 144),
}


@dataclass
class Pair:
    """Two BGR images, the left one's disparities in px (NaN: unknown), and the judged pixels."""

    left: np.ndarray
    right: np.ndarray
    truth_px: np.ndarray
    judged: np.ndarray


def read_pfm(path):
    _, size, scale, values = path.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    return np.frombuffer(values, "<f4" if float(scale) < 0 else ">f4").reshape(height, width)[::-1]


def read_truth(path, scale):
    truth = read_pfm(path) if path.suffix == ".pfm" else cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    truth = truth.astype(np.float32) / scale
    truth = truth if truth.ndim == 2 else truth[..., 0]
    return np.where(np.isfinite(truth) & (truth > 0), truth, np.nan)


def seen_by_both(truth):
    """Pixels whose partner is in the right image and not hidden by a nearer one."""
    height, width = truth.shape
    y, x = np.mgrid[:height, :width]
    partner = np.rint(x - np.nan_to_num(truth)).astype(int)
    inside = np.isfinite(truth) & (partner >= 0)
    nearest = np.full((height, width), -1, np.float32)
    np.maximum.at(nearest, (y[inside], partner[inside]), truth[inside])
    return inside & (truth >= nearest[y, np.clip(partner, 0, width - 1)] - 1)


def read_scene(data: Path, name):
    left, right, truth, scale, _ = SCENES[name]
    truth_px = read_truth(data / name / truth, scale)
    return Pair(cv2.imread(str(data / name / left)), cv2.imread(str(data / name / right)), truth_px,
                seen_by_both(truth_px))
