"""Calls that a type checker accepts."""
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import vantage
import vantage.opencv

left: NDArray[np.uint8] = vantage.read_image("left.png", band=1, orientation="stored")
right: NDArray[np.uint8] = vantage.read_image(Path("right.png"), band="auto", bgr=True)
matcher = vantage.Matcher("balanced", (0, 31), fill="none", cross_check=1.5, surface_fit="on",
                          threads=2, roi=(0, 0, 10, 10), raw=True, noise=None)
vantage.Matcher(disparities="auto", disparities_y=(-2, 2), preset="auto", executor="serial")
result: vantage.MatchResult = matcher.compute(left, right, right_disparity=True)
depth: NDArray[np.float32] = result.depth("calib.txt", max_depth=2, calibration_unit="mm")
cloud: vantage.PointCloud = result.cloud(focal_length=720, baseline=0.1, principal_point=(3, 4.5))
mesh: vantage.Mesh = vantage.mesh(result.disparity, left, cloud_step=2, reference="right")
vantage.reproject(depth, np.eye(4), reference="right", threads="auto")
vantage.synthesize(left, right, [0.25, 0.75], holes="inpaint", sweep=None, look_at="ahead")
vantage.synthesize(left, right, path=[{"frame": 0, "view": [0, 0]}], soft_edges="off")
vantage.rectify(left, right, Path("calib.yml"), white_level=4095).calibration.baseline.hex()
for frame in vantage.Sequence(Path("left"), "right", save=["disparity", "views"], view=[0, 0.5],
                              baselines=[1, 2.5], more="third", every=10, in_flight="auto",
                              stereo_views=(0, 1), temporal_prior=1, reuse="frame", mask="m.png"):
    print(frame.index + 1, frame.disparity.shape)
vantage.opencv.StereoVantage_create(0, 64, preset="quality", surface_fit=3).compute(left, right)
