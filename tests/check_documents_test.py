"""Plants one violation at a time in a small tree and expects check_documents to name it."""

import unittest

from planted_tree import PlantedTreeTest

EQUATIONS = "# The equations\n\n## 0. Conventions\n\n## 1. SSD\n\n### 1.2 Borders\n\nSee §0.\n"
CLEAN_TREE = {
    "docs/EQUATIONS.md": EQUATIONS,
    "README.md": "# Name\n\n[a](docs/EQUATIONS.md#1-ssd) [b](#name) [c](https://example.org/x)\n"
                 "![picture](docs/picture.png)\n```sh\nls [d](nowhere)\n```\n`[e](nowhere)`\n",
    "docs/picture.png": "",
    "kernels/box.h": "/// Sums (EQUATIONS §0, §1.2), as docs/EQUATIONS.md says.\n",
    "tests/box_test.cc": "/// §1 once more.\n",
}


class CheckDocumentsTest(PlantedTreeTest):
    script = "check_documents"
    clean_tree = CLEAN_TREE

    def test_accepts_a_clean_tree(self):
        self.expect_clean()

    def test_rejects_a_tree_without_equations(self):
        self.assertNotEqual(self.check({"README.md": "# Name\n"}).returncode, 0)

    def test_sections_that_do_not_exist(self):
        for name, text, section in [
                ("kernels/a.h", "// one line\n/// EQUATIONS §2", "§2"),
                ("engine/a.cc", "//\n// (EQUATIONS §1, §1.3)", "§1.3"),
                ("tests/a_test.cc", "\n/// EQUATIONS\n/// §7, wrapped", "§7"),
                ("docs/EQUATIONS.md", EQUATIONS + "See §3.", "§3")]:
            with self.subTest(name=name):
                self.expect_violation(name, text, f"{section}, expected a section")

    def test_long_lines_of_prose(self):
        long = "word " * 21
        self.expect_violation("docs/GUIDE.md", f"# Guide\n\n{long}\n", "docs/GUIDE.md:3: 105 columns")
        for name, text in [("docs/GUIDE.md", f"| {long} |\n"), ("perf/log/a.md", long),
                           ("docs/GUIDE.md", f"```sh\n{long}\n```\n")]:
            with self.subTest(name=name, text=text):
                self.assertEqual(self.check({**CLEAN_TREE, name: text}).returncode, 0)

    def test_a_section_that_is_removed(self):
        result = self.check({**CLEAN_TREE,
                             "docs/EQUATIONS.md": EQUATIONS.replace("### 1.2 Borders", "Borders")})
        self.assertEqual(result.returncode, 1)
        self.assertIn("kernels/box.h:1: §1.2", result.stdout)

    def test_documents_that_do_not_exist(self):
        self.expect_violation("apps/a.cc", "\n// docs/GONE.md\n", "apps/a.cc:2: there is no docs/GONE.md")
        self.expect_violation("docs/a.md", "See `perf/GONE.md`.", "docs/a.md:1: there is no perf/GONE.md")

    def test_links_that_lead_nowhere(self):
        self.expect_violation("docs/a.md", "\n[x](GONE.md)\n", "docs/a.md:2: link to 'GONE.md'")
        self.expect_violation("docs/a.md", "[x](../docs/EQUATIONS.md#2-gone)", "no such heading")
        self.expect_violation("perf/a.md", "# A\n[x](#b)", "perf/a.md:2: link to '#b'")
        self.expect_violation("docs/a.md", "![x](gone.png)", "docs/a.md:1: link to 'gone.png'")

    def test_figures_that_differ(self):
        table = ('[values]\nbad = "7.5"\nrate = "11.9"\n[quotes]\n"a.md" = ["| {bad} / … % |", '
                 '"makes {rate:.0f} a second"]\nhelp = ["fast {bad} % bad"]\n')
        page = "| 7.5 / 9 % |\n\nIt makes 12\na second.\n"
        tree = {**CLEAN_TREE, "docs/figures.toml": table, "a.md": page,
                "apps/a.cc": '"fast  7.5 "\n  "% bad"\n'}
        self.assertEqual(self.check(tree).returncode, 0)
        for name, text in [("a.md", page.replace("7.5", "7.6")), ("a.md", page.replace("12", "11")),
                           ("a.md", page.replace("/ 9 %", "")), ("apps/a.cc", '"fast 7.4 % bad"')]:
            with self.subTest(name=name, text=text):
                result = self.check({**tree, name: text})
                self.assertEqual(result.returncode, 1)
                self.assertIn("does not say", result.stdout)

    def test_places_that_do_not_exist(self):
        text = "`io/box`, `box.h`,\n`box_x`, `make_box`, `--option`, `NAME`, `kernels/`\n"
        tree = {**CLEAN_TREE, "engine/io/box.h": "int make_box();", "kernels/box_x/box_x_simd.cc": ""}
        for name in ["docs/ARCHITECTURE.md", "engine/io/README.md"]:
            self.assertEqual(self.check({**tree, name: text}).returncode, 0)
            for known, gone in [("io/box", "image/box"), ("make_box", "make_boxes"), ("box.h", "bag.h")]:
                result = self.check({**tree, name: text.replace(known, gone)})
                self.assertEqual(result.returncode, 1)
                self.assertIn(f"there is no '{gone}'", result.stdout)


if __name__ == "__main__":
    unittest.main()
