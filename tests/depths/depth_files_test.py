#!/usr/bin/env python3
"""Depth maps, clouds and meshes of the program, read by plain readers and compared with what a few
lines of Python make of its disparity map. usage: depth_files_test.py VANTAGE"""

import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from plain_readers import read_npy, read_pfm, read_ply, read_png

WIDTH, HEIGHT = 97, 61
FOCAL_PX, BASELINE_M, DOFFS_PX = 110.0, 0.16, 3.5
CENTRE_PX = (40.25, 33.5)


def vantage(*arguments, fails=False):
    done = subprocess.run([VANTAGE, *map(str, arguments)], capture_output=True, text=True)
    assert (done.returncode != 0) == fails, f"{arguments}: {done.returncode} {done.stderr}"
    return done.stderr


class DepthFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        os.chdir(cls.folder.name)
        vantage("generate", "scene", "-o", "scene", "--width", WIDTH, "--height", HEIGHT,
                "--samples", 1, "--far", 2, "--near", 20)
        with open("calib.txt", "w") as file:  # Middlebury's, in millimetres
            file.write(f"cam0=[{FOCAL_PX} 0 {CENTRE_PX[0]}; 0 {FOCAL_PX} {CENTRE_PX[1]}; 0 0 1]\n"
                       f"cam1=[{FOCAL_PX} 0 {CENTRE_PX[0] + DOFFS_PX}; 0 {FOCAL_PX} {CENTRE_PX[1]};"
                       f" 0 0 1]\ndoffs={DOFFS_PX}\nbaseline={1000 * BASELINE_M}\n"
                       f"width={WIDTH}\nheight={HEIGHT}\n")
        cls.image = read_png("scene/left.png")
        cls.map = read_pfm("scene/left-disparity.pfm")

    @classmethod
    def tearDownClass(cls):
        os.chdir("/")
        cls.folder.cleanup()

    def depth(self, d):
        return FOCAL_PX * BASELINE_M / (d + DOFFS_PX)

    def point(self, x, y, d):
        z = self.depth(d)
        return ((x - CENTRE_PX[0]) * z / FOCAL_PX, (y - CENTRE_PX[1]) * z / FOCAL_PX, z)

    def kept(self, map, step=1, mask=None, limit=1.0):
        """The pixels that become points, in order."""
        def is_kept(x, y):
            beside = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)]
            return (math.isfinite(map[y][x]) and not (mask and mask[y][x][0])
                    and all(abs(map[v][u] - map[y][x]) <= limit for u, v in beside
                            if 0 <= u < WIDTH and 0 <= v < HEIGHT and math.isfinite(map[v][u])))
        return [(x, y) for y in range(0, HEIGHT, step) for x in range(0, WIDTH, step)
                if is_kept(x, y)]

    def check_points(self, points, pixels, map, image):
        self.assertEqual(len(points), len(pixels))
        for point, (x, y) in zip(points, pixels):
            truth = self.point(x, y, map[y][x])
            self.assertLess(math.dist((point["x"], point["y"], point["z"]), truth),
                            1e-4 * math.hypot(*truth))
            self.assertEqual((point["red"], point["green"], point["blue"]), tuple(image[y][x]))
        for axis in range(3):  # bounds
            values = [self.point(x, y, map[y][x])[axis] for x, y in pixels]
            read = [point["xyz"[axis]] for point in points]
            self.assertAlmostEqual(min(read), min(values), places=4)
            self.assertAlmostEqual(max(read), max(values), places=4)

    def test_exact_maps_give_exact_files(self):
        vantage("reproject", "scene/left-disparity.pfm", "--image", "scene/left.png",
                "--calibration", "calib.txt", "--cloud", "c.ply", "--mesh", "m.ply", "--depth",
                "z.png", "--report", "r.json")
        pixels = self.kept(self.map)
        self.assertLess(len(pixels), WIDTH * HEIGHT)
        points, faces, comments = read_ply("c.ply")
        self.check_points(points, pixels, self.map, self.image)
        self.assertEqual(faces, [])
        self.assertIn("x right, y down, z ahead", comments[0])
        self.assertEqual(json.loads(Path("r.json").read_text())["results"]["cloud"]["points"], len(points))
        for row, depths in zip(self.map, read_png("z.png")):
            for d, (millimetres,) in zip(row, depths):
                self.assertLessEqual(abs(millimetres - 1000 * self.depth(d)), 0.5001)
        # The mesh has these points, and its triangles are small ones of neighbours.
        vertices, faces, _ = read_ply("m.ply")
        place = {tuple(p.values()): xy for p, xy in zip(points, pixels)}
        grid = [place[tuple(v.values())] for v in vertices]
        wanted = set(pixels)
        count = 0
        for y in range(HEIGHT - 1):
            for x in range(WIDTH - 1):
                square = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)]
                d = [self.map[v][u] for u, v in square]
                jumps = any(abs(d[a] - d[b]) > 1 for a, b in [(0, 1), (0, 2), (1, 3), (2, 3)])
                corners = sum(corner in wanted for corner in square)
                count += max(0, corners - 2) if not jumps else 0
        self.assertEqual(len(faces), count)
        for face in faces:
            xs, ys = zip(*(grid[i] for i in face))
            self.assertEqual((max(xs) - min(xs), max(ys) - min(ys)), (1, 1))

    def test_a_match_leaves_out_what_it_guessed(self):
        vantage("match", "scene/left.png", "scene/right.png", "-o", "d.pfm", "--unmatched", "u.png",
                "--confidence", "conf.npy", "--calibration", "calib.txt", "--cloud", "c.ply",
                "--cloud-confidence", "--cloud-step", 2, "--depth", "z.npy", "--max-depth", 2.5)
        map, mask = read_pfm("d.pfm"), read_png("u.png")
        confidence, depths = read_npy("conf.npy"), read_npy("z.npy")
        self.assertTrue(any(value for row in mask for value, in row))
        for y in range(HEIGHT):
            for x in range(WIDTH):
                z = self.depth(map[y][x])
                if z <= 2.5:
                    self.assertAlmostEqual(depths[y][x], z, places=5)
                else:
                    self.assertTrue(math.isnan(depths[y][x]))
        pixels = [(x, y) for x, y in self.kept(map, 2, mask) if self.depth(map[y][x]) <= 2.5]
        points, _, _ = read_ply("c.ply")
        self.check_points(points, pixels, map, self.image)
        for point, (x, y) in zip(points, pixels):
            self.assertEqual(point["confidence"], confidence[y][x])
        vantage("match", "scene/left.png", "scene/right.png", "-o", "d.pfm", "--calibration",
                "calib.txt", "--cloud", "all.ply", "--cloud-filled", "--cloud-outlines")
        self.assertEqual(len(read_ply("all.ply")[0]), WIDTH * HEIGHT)

    def test_the_right_map_has_the_same_frame(self):
        """The same surfaces, seen by the right camera."""
        both = []
        for side in ["left", "right"]:
            vantage("reproject", f"scene/{side}-disparity.pfm", "--image", f"scene/{side}.png",
                    "--reference", side, "--focal-length", FOCAL_PX, "--baseline", BASELINE_M,
                    "--doffs", DOFFS_PX, "--principal-point", f"{CENTRE_PX[0]},{CENTRE_PX[1]}",
                    "--cloud", "c.ply")
            both.append(read_ply("c.ply")[0])
        self.check_points(both[0], self.kept(self.map), self.map, self.image)
        near = {}
        for p in both[0]:
            near.setdefault(tuple(round(p[axis] / 0.05) for axis in "xyz"), []).append(p)
        cells = [tuple(round(p[axis] / 0.05) for axis in "xyz") for p in both[1]]
        shared = sum(any((i + a, j + b, k + c) in near for a in (-1, 0, 1) for b in (-1, 0, 1)
                         for c in (-1, 0, 1)) for i, j, k in cells)
        self.assertGreater(shared, 0.9 * len(cells))

    def test_bad_input_writes_nothing(self):
        map = ["reproject", "scene/left-disparity.pfm"]
        scale = ["--calibration", "calib.txt"]
        with open("opencv.yml", "w") as file:
            file.write("Q: [1, 0, 0, -40, 0, 1, 0, -33, 0, 0, 0, 110, 0, 0, 6.25, 0]\n")
        for arguments, text in [
                (map + ["--depth", "no.png"], "needs --calibration, or --focal-length and"),
                (map + scale, "there is nothing to write"),
                (map + scale + ["--cloud", "no.ply", "--image", "u16.png"], "no such file"),
                (map + scale + ["--depth", "no.jpg"], "expected a file name that ends in"),
                (map + scale + ["--cloud", "no.ply", "--image", "scene/left.png", "--max-depth",
                                "1e-3"], "the cloud is empty"),
                (map + ["--depth", "no.npy", "--calibration", "opencv.yml"],
                 "does not say how long its unit is"),
                (map + ["--depth", "no.npy", "--focal-length", "9"], "--baseline METRES beside"),
                (map + scale + ["--depth", "no.npy", "--baseline", "1", "--calibration-unit", "m"],
                 "expected one of them"),
                (map + scale + ["--depth", "no.npy", "--cloud-step", "2"], "has no effect without"),
        ]:
            error = vantage(*arguments, fails=True)
            self.assertIn(text, error)
            self.assertEqual(error.count("\n"), 1, error)
        self.assertEqual([name for name in os.listdir() if name.startswith(("no", ".no"))], [])
        with open("half.pfm", "wb") as file:
            file.write(b"Pf\n2 2\n-1\n" + bytes(16))
        error = vantage("reproject", "half.pfm", "--image", "scene/left.png", "--focal-length", 9,
                        "--baseline", 1, "--cloud", "no.ply", fails=True)
        self.assertIn("the image is 97x61 but the disparity map is 2x2", error)
        vantage(*map, "--depth", "z.npy", "--calibration", "opencv.yml", "--calibration-unit", "cm")
        self.assertAlmostEqual(read_npy("z.npy")[5][5], 1.1 * 0.16 / self.map[5][5], places=5)

    def test_a_run_writes_the_same(self):
        for side in ["left", "right"]:
            os.makedirs(f"frames/{side}", exist_ok=True)
            os.link(f"scene/{side}.png", f"frames/{side}/0.png")
        common = ["--calibration", "calib.txt", "--disparities", "0:24", "--cloud-step", 3]
        vantage("run", "--left", "frames/left", "--right", "frames/right", "-o", "out", "--save",
                "depth,cloud,mesh", *common)
        vantage("match", "scene/left.png", "scene/right.png", "-o", "d.pfm", "--depth", "z.png",
                "--cloud", "c.ply", "--mesh", "m.ply", *common)
        for file, of_run in [("z.png", "depth/000000.png"), ("c.ply", "cloud/000000.ply"),
                             ("m.ply", "mesh/000000.ply")]:
            self.assertEqual(Path(file).read_bytes(), Path("out", of_run).read_bytes(), file)

    def test_poses_put_the_clouds_into_the_world(self):
        for side in ["left", "right"]:
            os.makedirs(f"moving/{side}", exist_ok=True)
            for name in ["10.000001.png", "10.500000.png"]:
                os.link(f"scene/{side}.png", f"moving/{side}/{name}")
        # A quarter turn to the right and 5 m ahead; then also 2 m up.
        turn = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
        half = math.sqrt(0.5)
        places = [(0, 0, 5), (0, -2, 5)]
        with open("kitti.txt", "w") as kitti, open("tum.txt", "w") as tum:
            tum.write("# time tx ty tz qx qy qz qw\n3 9 9 9 0 0 0 1\n")
            for time, place in zip(["10.01", "10.49"], places):
                kitti.write(" ".join(f"{a} {b} {c} {t}" for (a, b, c), t in zip(turn, place)) + "\n")
                tum.write(f"{time} {place[0]} {place[1]} {place[2]} 0 {half} 0 {half}\n")
        run = ["run", "--left", "moving/left", "--right", "moving/right", "--save", "cloud",
               "--calibration", "calib.txt", "--disparities", "0:24", "--cloud-step", 5]
        vantage(*run, "-o", "camera")
        for name in ["kitti", "tum"]:
            vantage(*run, "-o", name, "--poses", f"{name}.txt")
            for frame, place in enumerate(places):
                points, _, _ = read_ply(f"camera/cloud/{frame:06}.ply")
                world, _, comments = read_ply(f"{name}/cloud/{frame:06}.ply")
                self.assertIn("world", comments[0])
                self.assertEqual(len(world), len(points))
                for p, w in zip(points, world):
                    truth = [sum(turn[i][k] * p["xyz"[k]] for k in range(3)) + place[i]
                             for i in range(3)]
                    self.assertLess(math.dist(truth, (w["x"], w["y"], w["z"])), 1e-4)
        self.assertIn("verify: 2 files", vantage("verify", "kitti"))
        vantage("run", "-o", "kitti", "--resume")
        with open("kitti.txt", "a") as kitti:
            kitti.write("\n1 0 0 0 0 1 0 0 0 0 1 0\n")
        self.assertIn("poses", vantage("run", "-o", "kitti", "--resume", fails=True))
        with open("short.txt", "w") as file:
            file.write("1 0 0 0 0 1 0 0 0 0 1 0\n")
        error = vantage(*run, "-o", "none", "--poses", "short.txt", fails=True)
        self.assertIn("short.txt: has 1 poses, expected one for each pair from 0 to 1", error)
        error = vantage(*run[:6], "depth", *run[7:9], "-o", "none", "--poses", "tum.txt",
                        fails=True)
        self.assertIn("--poses has no effect where --save has no cloud, mesh", error)


if __name__ == "__main__":
    VANTAGE = sys.argv[1]
    unittest.main(argv=sys.argv[:1], verbosity=2)
