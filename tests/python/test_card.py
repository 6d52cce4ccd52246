"""The verdict of a result as HTML and as text."""

import copy
import unittest
from html.parser import HTMLParser
from types import SimpleNamespace
from typing import Any

from small_cases import block, solved

import tribound as tb
from tribound import card
from tribound.words import number, percent, typeset


class Page(HTMLParser):
    """The tags and the text of a card; fails where tags do not close in order."""

    def __init__(self, html: str) -> None:
        super().__init__(convert_charrefs=True)
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[str] = []
        self.feed(html)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.open.append(tag)
        self.tags.append((tag, dict(attributes)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)


def changed(**changes: Any) -> Any:
    certificate = copy.deepcopy(solved(2, 2).certificate)
    return SimpleNamespace(certificate={**certificate, **changes})


class Card(unittest.TestCase):
    def words(self, result: tb.Result) -> str:
        return " ".join(Page(card.html(result)).words)

    def test_says_what_is_guaranteed(self) -> None:
        result = solved(2, 2)
        words = self.words(result)
        self.assertIn("Certified", words)
        self.assertIn(f"guaranteed to be at most {percent(result.relative)} of the norm of the stress", words)
        self.assertIn("MPa mm", words)
        self.assertEqual(result._repr_html_(), card.html(result))

    def test_markup_in_names_is_text(self) -> None:
        evil = '<script>alert("1")</script>&'
        quantity = {"name": evil, "value": 1.0, "lower": 0.9, "upper": 1.1, "exact": False, "reason": None}
        result = changed(
            title=evil,
            file=evil,
            reason=evil,
            status="budget",
            quantities=[quantity],
            friction=evil,
            warnings=[{"where": evil, "text": evil}],
        )
        page = Page(card.html(result))
        self.assertNotIn("script", [tag for tag, _ in page.tags])
        self.assertEqual(sum(words.count(evil) for words in page.words), 7)

    def test_every_status(self) -> None:
        for status, words in (
            ("budget", "Budget used up"),
            ("not certified", "nothing is guaranteed"),
            ("failed", "No solution was found"),
        ):
            with self.subTest(status=status):
                result = changed(status=status, reason="newton.max_steps is reached")
                self.assertIn(words, self.words(result))
                self.assertIn("ewton.max_steps is reached", self.words(result))
                self.assertIn("ewton.max_steps is reached", card.text(result))

    def test_run_that_fails(self) -> None:
        result = tb.run(block(2, 1, newton={"max_steps": 1, "stopping": "tolerance"}))
        self.assertEqual(result.status, "failed")
        self.assertIn("No solution was found: ", self.words(result))
        self.assertIn("No solution was found: ", repr(result))

    def test_run_that_ended_before_its_first_level(self) -> None:
        result = changed(status="failed", reason="interrupted", levels=[])
        for key in ("cells", "dofs", "bound", "relative"):
            del result.certificate[key]
        self.assertIn("No solution was found: interrupted.", self.words(result))
        self.assertIn("interrupted", card.text(result))

    def test_quantities_have_their_bars(self) -> None:
        bar = {"name": "N", "value": 1.25, "lower": 1.2, "upper": 1.375, "exact": False, "reason": None}
        unknown = {
            "name": "M",
            "value": 2.0,
            "lower": None,
            "upper": None,
            "exact": False,
            "reason": "there is no bound",
        }
        result = changed(quantities=[bar, unknown], units={"quantities": {"N": "N/mm", "M": "N"}})
        for words in (self.words(result), card.text(result)):
            self.assertIn("between 1.2 and 1.375 N/mm", words)
            self.assertIn("no error bar", words)

    def test_load_steps(self) -> None:
        steps = [{"relative_path": 0.002}, {"relative_path": 0.013}]
        self.assertIn(
            "is guaranteed to be at most 1.3\u00a0% of the largest norm of the stress up to it",
            self.words(changed(steps=steps)),
        )

    def test_text_is_short(self) -> None:
        lines = card.text(solved(2, 2)).splitlines()
        self.assertIn(len(lines), range(3, 6))
        self.assertEqual(repr(solved(2, 2)), card.text(solved(2, 2)))

    def test_numbers_as_on_the_page(self) -> None:
        for value, words in (
            (0, "0"),
            (0.012340, "0.01234"),
            (1.2345e-5, "1.234×10⁻⁵"),
            (-2.5, "−2.5"),
            (1e-7, "10⁻⁷"),
            (99999, "100000"),
            (12345.6, "12346"),
            (None, "–"),
            (1e9, "10⁹"),
        ):
            self.assertEqual(number(value, 5 if value == 12345.6 else 4), words)
        self.assertEqual(typeset("MPa mm^(3/2)"), "MPa mm¹·⁵")
        self.assertEqual(typeset("mm^2"), "mm²")


if __name__ == "__main__":
    unittest.main()
