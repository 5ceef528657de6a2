"""Calls that a type checker refuses: those of the lines that say why."""
import numpy as np

import vantage
import vantage.opencv

left = right = np.zeros((8, 8), np.uint8)
vantage.Matcher(surface_fitt=1)  # wrong: name
vantage.Matcher(fill="nothing")  # wrong: choice
vantage.Matcher("fast")  # wrong: choice
vantage.Matcher(threads=1.5)  # wrong: type
vantage.Matcher(raw="yes")  # wrong: type
vantage.Matcher(disparities=31)  # wrong: type
vantage.Matcher(roi=(1, 2))  # wrong: length
result = vantage.Matcher().compute(left, right)
result.depth(threads=2)  # wrong: that of the matcher counts
result.cloud(calibration_unit="km")  # wrong: choice
vantage.depth(result.disparity, already_rectified=True)  # wrong: of Calibration.load
vantage.reproject(result.disparity, "calib.txt", reference="middle")  # wrong: choice
vantage.synthesize(left, right, holes=1)  # wrong: type
vantage.rectify(left, right, preset="quality")  # wrong: name
vantage.read_image("left.png", band="first")  # wrong: choice
vantage.Sequence("left", "right", save=["depth"])  # wrong: not of frames
vantage.Sequence("left", "right", raw_video="4x4")  # wrong: of streams
vantage.Sequence("left", "right", keep_going=2.0)  # wrong: type
vantage.opencv.StereoVantage_create(disparities=(0, 7))  # wrong: numDisparities
result.disparity.nothing  # wrong: attribute
