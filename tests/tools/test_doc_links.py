# SPDX-FileCopyrightText: Sand Reckoner contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The link checker accepts good links and reports broken ones."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import doc_links  # noqa: E402  (the path above comes first)


class DocLinks(unittest.TestCase):
    def broken(self, text):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder).resolve()
            (root / "docs").mkdir()
            (root / "docs" / "other.md").write_text("# Other page\n\n## The `skin`, and why\n\n- <a id=\"term\"></a>**Term**: one.\n")
            page = root / "docs" / "page.md"
            page.write_text(text)
            return list(doc_links.broken_links(page, root))

    def test_good_links(self):
        self.assertEqual(self.broken("[a](other.md) [b](other.md#the-skin-and-why) [c](../docs/) [t](other.md#term)\n"
                                     "[d](https://example.org) ![e](other.md \"title\")\n"
                                     "# Here\n[f](#here)\n"), [])

    def test_code_is_no_link(self):
        self.assertEqual(self.broken("`[a](none.md)`\n```\n[b](none.md)\n```\n"), [])

    def test_broken_links(self):
        for text in ("[a](none.md)", "[a](other.md#nothing)", "[a](#nothing)", "[a](../../up.md)"):
            self.assertEqual(len(self.broken(text)), 1, text)

    def test_line_numbers(self):
        self.assertTrue(self.broken("\n```\ncode\n```\n[a](none.md)\n")[0].startswith("docs/page.md:5:"))


if __name__ == "__main__":
    unittest.main()
