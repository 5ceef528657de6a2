"""Plants one violation at a time in a small tree and expects check_layers to name it."""

import unittest

from planted_tree import PlantedTreeTest

CLEAN_TREE = {
    "kernels/box.h": "#pragma once\n#include <cstddef>\n",
    "kernels/box.cc": '#include "kernels/box.h"\n#include <hwy/highway.h>\n',
    "kernels/lanes-inl.h": "int per_target();\n",
    "scheduler/pool.cc": "#include <hwloc.h>\n#include <oneapi/tbb/task_arena.h>\n#include <omp.h>\n",
    "engine/io.cc": '#include <opencv2/imgcodecs.hpp>\n#include <unistd.h>\n#include "kernels/box.h"\n',
    "engine/io/video/libav_functions.h": "#pragma once\n#include <libavcodec/avcodec.h>\n",
    "engine/video.cc": 'extern "C" {\n#include <libavcodec/avcodec.h>\n#include <libswscale/swscale.h>\n}\n',
    "apps/main.cc": '#include <CLI/CLI.hpp>\n#include "engine/io.h"\n',
    "tests/engine/io_test.cc": "#include <gtest/gtest.h>\n#include <thread>\n",
}


class CheckLayersTest(PlantedTreeTest):
    script = "check_layers"
    clean_tree = CLEAN_TREE

    def test_accepts_a_clean_tree(self):
        self.expect_clean()

    def test_rejects_a_tree_that_is_not_there(self):
        self.assertNotEqual(self.check({"other/file": ""}).returncode, 0)

    def test_includes_that_cross_layers(self):
        for name, include in [
                ("kernels/a.cc", '"scheduler/executor.h"'), ("kernels/a.cc", '"engine/image.h"'),
                ("kernels/a.cc", "<unistd.h>"), ("kernels/a.cc", "<opencv2/core.hpp>"),
                ("scheduler/a.cc", '"kernels/box.h"'), ("scheduler/a.cc", '"engine/image.h"'),
                ("scheduler/a.cc", "<fmt/format.h>"),
                ("engine/a.cc", '"apps/command.h"'), ("engine/a.cc", "<tbb/parallel_for.h>"),
                ("engine/a.cc", "<omp.h>"), ("engine/deep/a.cc", "<hwloc.h>"),
                ("engine/a.cc", "<CLI/CLI.hpp>"), ("engine/options/a.cc", "<toml++/toml.h>"),
                ("python/a.cc", '"apps/settings/toml_file.h"'), ("engine/a.cc", "<linux/perf_event.h>"),
                ("apps/a.cc", '"kernels/box.h"'), ("apps/a.cc", "<opencv2/core.hpp>"),
                ("apps/a.cc", "<oneapi/tbb/task_arena.h>")]:
            with self.subTest(name=name, include=include):
                self.expect_violation(name, f"// text\n#  include {include}\n", f"{name}:2: ")

    def test_what_kernels_do_without(self):
        for header in ["thread", "vector", "fstream", "iostream", "memory", "cstdio"]:
            with self.subTest(header=header):
                self.expect_violation("kernels/a.cc", f"#include <{header}>\n", "kernels/a.cc:1: ")

    def test_opencv_in_a_public_header(self):
        self.expect_violation("engine/a.h", "#pragma once\n#include <opencv2/core.hpp>\n",
                              "engine/a.h:2: ")

    def test_ffmpeg_in_a_public_header_and_elsewhere(self):
        self.expect_violation("engine/a.h", "#pragma once\n#include <libavutil/frame.h>\n",
                              "engine/a.h:2: ")
        self.expect_violation("engine/a.h", "#pragma once\n#include <libswscale/swscale.h>\n",
                              "engine/a.h:2: ")
        self.expect_violation("apps/a.cc", "#include <libavcodec/avcodec.h>\n", "apps/a.cc:1: ")

    def test_folders_that_include_each_other(self):
        tree = {**CLEAN_TREE, "engine/a/x.cc": '#include "engine/b/deep/x.h"\n',
                "engine/b/deep/x.h": '#pragma once\n#include "engine/c/x.h"\n',
                "engine/b/deep/y.cc": '#include "engine/b/deep/x.h"\n',
                "engine/c/x.h": '#pragma once\n#include "kernels/box.h"\n'}
        self.assertEqual(self.check(tree).returncode, 0)
        for name in ["engine/c/y.cc", "engine/b/deep/z.cc"]:
            result = self.check({**tree, name: '#include "engine/a/x.h"\n'})
            self.assertEqual(result.returncode, 1, result.stdout)
            self.assertIn("engine/a/x.cc:1: folders include each other: engine/a -> engine/b/deep",
                          result.stdout)

    def test_the_core_includes_itself(self):
        tree = {**CLEAN_TREE, "engine/late.h": "#pragma once\n", "engine/border.h": "#pragma once\n",
                "engine/border.cc": "#include <opencv2/core.hpp>\n",
                "engine/CMakeLists.txt": "set(core_parts\n  image error)\nset(core_borders border)\n"}
        within = '#include <Eigen/Core>\n#include <unistd.h>\n#include "engine/border.h"\n'
        self.assertEqual(self.check({**tree, "engine/image/a.cc": within}).returncode, 0)
        for include in ["<opencv2/core.hpp>", "<png.h>", "<nlohmann/json.hpp>", '"engine/late.h"']:
            for name in ["engine/image/a.cc", "engine/error.cc"]:
                result = self.check({**tree, name: f"#include {include}\n"})
                self.assertIn(f"{name}:1: the core ", result.stdout)

    def test_private_header_in_a_public_one(self):
        self.expect_violation("engine/a.h", '#pragma once\n#include "engine/io/video/libav_functions.h"\n',
                              "engine/a.h:2: ")

    def test_printing_to_stderr(self):
        self.expect_violation("apps/a.cc", 'fmt::print(stderr, "text");\n', "apps/a.cc:1: ")
        self.expect_violation("apps/a.cc", 'std::fputs(text, stderr);\n', "apps/a.cc:1: ")

    def test_options_with_dashes_in_the_engine(self):
        self.expect_violation("engine/a.cc", 'throw Error("give --search-size");\n', "engine/a.cc:1: ")
        self.expect_violation("engine/a.cc", '"or --force to continue"\n', "engine/a.cc:1: ")
        for text in ['throw Error("give --search-size");\n', '/// "--force"\n', '"--- a"; --a;\n']:
            name = "apps/a.cc" if "search" in text else "engine/a.cc"
            self.assertEqual(self.check({**CLEAN_TREE, name: text}).returncode, 0, text)

    def test_header_without_pragma_once(self):
        self.expect_violation("tests/engine/a.h", "int a();\n", "tests/engine/a.h:1: ")

    def test_length(self):
        self.assertEqual(self.check({**CLEAN_TREE, "apps/a.cc": "\n" * 600}).returncode, 0)
        self.expect_violation("apps/a.cc", "\n" * 601, "apps/a.cc:601: ")

    def test_native_instructions(self):
        self.expect_violation("engine/CMakeLists.txt", "target_compile_options(e -march=native)\n",
                              "engine/CMakeLists.txt:1: ")


if __name__ == "__main__":
    unittest.main()
