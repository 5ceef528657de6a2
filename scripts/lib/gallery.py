#!/usr/bin/env python3
"""Makes the gallery of the documentation site: five scenes, OpenCV's map beside Vantage's.

usage: gallery.py VANTAGE PHOTOGRAPHS_DIR OUT [WIDTH]

Writes OUT/gallery.md and its pictures. One scene is a photograph (aloeL.jpg, aloeR.jpg and the truth
aloeGT.png of PHOTOGRAPHS_DIR; without them one scene less). The others are generated, WIDTH (640)
pixels wide.
"""
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

WIDTH_PX = 400
# Focal length and offset in pixels, baseline in metres.
ALOE_CAMERA = {"focal-length": 3740, "baseline": 0.16, "doffs": 270}
SCENES = [
    ("Walls and slanted planes", "A generated scene with little noise.", []),
    ("Noise", "The same with noise of 6 grey levels in both images.", ["--noise", "6"]),
    ("Cameras of different brightness", "The right camera has 1.3 times the gain and an offset of 10.",
     ["--right-gain", "1.3", "--right-offset", "10"]),
    ("A wide range of disparities", "Disparities up to a seventh of the width.",
     ["--near", "{seventh_of_width}", "--seed", "3"]),
]


def vantage(program, *words):
    subprocess.run([program, *map(str, words), "--quiet"], check=True)


def coloured(disparity_px, max_px):
    """False colours, black where the disparity is unknown."""
    known = np.isfinite(disparity_px)
    scaled = np.clip(np.where(known, disparity_px, 0) * (255 / max_px), 0, 255).astype(np.uint8)
    picture = cv2.applyColorMap(scaled, cv2.COLORMAP_TURBO)
    picture[~known] = 0
    return picture


def opencv_map(left, right, disparities):
    """StereoSGBM with three paths, block 3 and its post-processing; NaN: unknown. Columns are added
    at the left, because it leaves a band as wide as its range unmatched there."""
    count = -(-disparities // 16) * 16
    left, right = (cv2.copyMakeBorder(image, 0, 0, count, 0, cv2.BORDER_REPLICATE)
                   for image in (left, right))
    matcher = cv2.StereoSGBM_create(
        0, count, 3, P1=8 * 3 * 9, P2=32 * 3 * 9, disp12MaxDiff=1,
        uniquenessRatio=10, speckleWindowSize=100, speckleRange=2,
        mode=cv2.STEREO_SGBM_MODE_SGBM_3WAY)
    found = matcher.compute(left, right)[:, count:].astype(np.float32) / 16
    return np.where(found < 0, np.nan, found)


def bad_percent(disparity_px, truth_px, known):
    """Share of judged pixels whose disparity is unknown or wrong by more than 1 px."""
    judged = known & np.isfinite(truth_px)
    wrong = ~(np.abs(disparity_px - truth_px) <= 1)
    return 100 * wrong[judged].mean()


def cloud_picture(path, size, focal_length_px):
    """A point cloud (binary PLY) seen from beside and above the camera; the focal length is that of
    the picture."""
    with open(path, "rb") as file:
        header = b""
        while not header.endswith(b"end_header\n"):
            header += file.readline()
        types = {"float": "<f4", "uchar": "u1", "float32": "<f4", "uint8": "u1"}
        fields = [line.split()[1:] for line in header.decode().splitlines()
                  if line.startswith("property")]
        points = np.frombuffer(file.read(), [(name, types[kind]) for kind, name in fields])
    xyz = np.stack([points["x"], points["y"], points["z"]], 1)
    centre = np.median(xyz, axis=0)
    turn, tilt = np.radians(-25), np.radians(12)
    about_y = np.array([[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]])
    about_x = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
    seen = (xyz - centre) @ about_y.T @ about_x.T + [0, 0, centre[2]]
    x, y = (np.round(seen[:, axis] / seen[:, 2] * 0.9 * focal_length_px + size[axis] / 2).astype(int)
            for axis in (0, 1))
    inside = (seen[:, 2] > 0) & (x >= 0) & (x < size[0]) & (y >= 0) & (y < size[1])
    order = np.argsort(-seen[inside, 2])    # near points are painted last
    picture = np.full((size[1], size[0], 3), 24, np.uint8)
    colours = np.stack([points["blue"], points["green"], points["red"]], 1)
    picture[y[inside][order], x[inside][order]] = colours[inside][order]
    return picture


def make_scene(program, name, left_file, right_file, camera, truth, out):
    """Writes the pictures of a scene; returns the figures for its caption."""
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        map_file, cloud_file = work / "map.npy", work / "cloud.ply"
        vantage(program, "match", left_file, right_file, "-o", map_file, "--cloud", cloud_file,
                *(word for option, value in camera.items() for word in (f"--{option}", value)))
        left, right = cv2.imread(str(left_file)), cv2.imread(str(right_file))
        ours = np.load(map_file)
        height_px, width_px = left.shape[:2]
        cloud = cloud_picture(cloud_file, (WIDTH_PX, round(WIDTH_PX * height_px / width_px)),
                              camera["focal-length"] * WIDTH_PX / width_px)
    max_px = float(np.nanmax(ours)) * 1.05
    theirs = opencv_map(left, right, int(max_px) + 1)
    pictures = {"left": left, "opencv": coloured(theirs, max_px), "vantage": coloured(ours, max_px),
                "cloud": cloud}
    for kind, picture in pictures.items():
        height = round(WIDTH_PX * picture.shape[0] / picture.shape[1])
        cv2.imwrite(str(out / f"{name}-{kind}.png"),
                    cv2.resize(picture, (WIDTH_PX, height), interpolation=cv2.INTER_AREA))
    return ("Wrong by more than 1 px, or without a disparity: "
            f"OpenCV {bad_percent(theirs, *truth):.1f} %, Vantage {bad_percent(ours, *truth):.1f} %.")


def main():
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    program, photographs, out = sys.argv[1], *map(pathlib.Path, sys.argv[2:4])
    width_px = int(sys.argv[4]) if len(sys.argv) == 5 else 640
    generated_camera = {"focal-length": width_px, "baseline": 0.1}
    (out / "gallery").mkdir(parents=True, exist_ok=True)
    text = ["# Gallery", "",
            "The left image, the map of OpenCV's StereoSGBM (three paths, block 3, with its checks: "
            "black is unknown), the map of `vantage match` without options, and the point cloud of "
            "`--cloud`. Red is near.", ""]
    with tempfile.TemporaryDirectory() as work:
        scenes = []
        if (photographs / "aloeGT.png").exists():
            truth = cv2.imread(str(photographs / "aloeGT.png"), cv2.IMREAD_GRAYSCALE)
            scenes.append(("Aloe", "A photograph of the Middlebury data set (Hirschmüller and "
                           "Scharstein, 2007), as in the Debian package opencv-doc.",
                           photographs / "aloeL.jpg", photographs / "aloeR.jpg", ALOE_CAMERA,
                           (truth.astype(np.float32), truth > 0)))
        for number, (title, caption, options) in enumerate(SCENES):
            folder = pathlib.Path(work) / str(number)
            vantage(program, "generate", "scene", "-o", folder, "--width", width_px,
                    "--height", width_px * 3 // 4,
                    *(word.format(seventh_of_width=width_px // 7) for word in options))
            truth = cv2.imread(str(folder / "left-disparity.pfm"), cv2.IMREAD_UNCHANGED)
            hidden = cv2.imread(str(folder / "left-occluded.png"), cv2.IMREAD_GRAYSCALE)
            scenes.append((title, caption, folder / "left.png", folder / "right.png",
                           generated_camera, (truth, hidden == 0)))
        for title, caption, left, right, camera, truth in scenes:
            name = title.lower().replace(" ", "-")
            figures = make_scene(program, name, left, right, camera, truth,
                                 out / "gallery")
            cells = [f"![{kind} of {title}](gallery/{name}-{kind}.png)"
                     for kind in ("left", "opencv", "vantage", "cloud")]
            text += [f"## {title}", "", f"{caption} {figures}".strip(), "",
                     "| left image | point cloud |", "|---|---|", f"| {cells[0]} | {cells[3]} |",
                     "| **OpenCV** | **Vantage** |", f"| {cells[1]} | {cells[2]} |", ""]
    (out / "gallery.md").write_text("\n".join(text))


if __name__ == "__main__":
    main()
