from __future__ import annotations

import unicodedata
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.commands.check import faults_of
from agentface.errors import UnknownNameError
from agentface.resources import rules_file
from agentface.speech.alphabets import ALPHABETS, load_phones, phone_table
from agentface.speech.visemes import viseme_table

GOOD = rules_file("phones.yaml").read_text()
# CMU's dictionary, and what flite's slt says besides
ARPABET = (
    "aa ae ah ao aw ay b ch d dh eh er ey f g hh ih iy jh k l m n ng ow oy p r s sh t th uh uw v w y z zh ax axr pau"
)
OCULUS = "sil PP FF TH DD kk CH SS nn RR aa E ih oh ou"
# what espeak-ng's voices say, sound by sound
ESPEAK = {
    "en-us": "æ ɐ ə ᵻ ɚ ɜː ɑː ɔː oː uː iː ɛ ɪ ʊ ʌ aɪ eɪ ɔɪ aʊ oʊ aɪə ɪɹ ɛɹ ɔːɹ "
    "p b t d k ɡ tʃ dʒ f v θ ð s z ʃ ʒ h m n ŋ l ɹ j w ɾ ʔ n̩ əl",
    "en-gb": "a ɒ ɑː ɜː əʊ eə iə ʊə aɪ eɪ ɔɪ aʊ i",
    "de": "a aː ɛ ɛː eː ɪ iː ɔ oː ʊ uː œ øː ʏ yː ə ɜ aɪ aʊ ɔø p b t d k ɡ pf ts tʃ f v s z ʃ ʒ ç x h m n ŋ l ɾ ʁ j ʔ",
    "fr": "a ɑ ɛ e i ɔ o u y ø œ ə ɑ̃ ɛ̃ ɔ̃ œ̃ p b t d k ɡ f v s z ʃ ʒ m n ɲ ŋ l ʁ j w ɥ",
    "es": "a e i o u aɪ aʊ eɪ eʊ oɪ p b t d k ɡ β ð ɣ tʃ f θ s x ʎ ʝ ɟʝ m n ɲ ŋ l ɾ r j w",
    "it": "a e ɛ i o ɔ u p b t d k ɡ ts dz tʃ dʒ f v s z ʃ ʎ ʎː m n ɲ ɲː l r ɾ j w pː tː kː bː ss",
}


def main(looks):
    """The main viseme of each part."""
    return [part.visemes[0][0] for part in looks]


@pytest.mark.parametrize(
    ("alphabet", "symbols"),
    [
        ("arpabet", ARPABET.split()),
        ("arpabet", [f"{symbol.upper()}1" for symbol in ARPABET.split()]),
        ("visemes", OCULUS.split()),
        ("visemes", [f"viseme_{name}" for name in OCULUS.split()]), ("azure", [str(number) for number in range(22)]),
        *(("ipa", symbols.split()) for symbols in ESPEAK.values()),
    ],
)  # fmt: skip
def test_alphabets_are_known(alphabet, symbols):
    looks = phone_table().looks(symbols, alphabet)
    assert len(looks) == len(symbols)
    for each in looks:
        assert each[0].start == 0.0
        assert each[-1].end == 1.0
        assert all(before.end == after.start for before, after in pairwise(each))
        assert {name for part in each for name, _ in part.visemes} <= set(viseme_table())


def test_what_the_lips_must_do_is_the_same_in_every_alphabet():
    for viseme, symbols in {
        "PP": {"arpabet": "p b m", "ipa": "p b m pʰ bː m̥ mʲ", "azure": "21", "visemes": "PP"},
        "FF": {"arpabet": "f v", "ipa": "f v fː", "azure": "18", "visemes": "FF"},
        "SS": {"arpabet": "s z", "ipa": "s z t͡s", "azure": "15", "visemes": "SS"},
        "sil": {"arpabet": "pau sil SIL _", "ipa": "sil _", "azure": "0 sil", "visemes": "sil"},
    }.items():
        for alphabet, listed in symbols.items():
            for looks in phone_table().looks(listed.split(), alphabet):
                assert main(looks) == [viseme]


def test_an_alphabet_is_told_by_all_that_is_said():
    y = "y"
    english, french = (phone_table().looks(symbols)[0] for symbols in ([y, "eh", "s"], [y, "ʁ", "l"]))
    assert main(english) == ["iy"]
    assert main(french) == ["ou"]
    assert main(phone_table().looks([y], "ipa")[0]) == ["ou"]


def test_diphthongs_go_from_one_vowel_to_the_other():
    for symbol, alphabet in (("ay", "arpabet"), ("AY2", "arpabet"), ("aɪ", "ipa"), ("11", "azure")):
        (looks,) = phone_table().looks([symbol], alphabet)
        assert main(looks) == ["aa", "ih"]
        assert looks[0].end == pytest.approx(0.55)
    assert main(phone_table().looks(["pf"], "ipa")[0]) == ["PP", "FF"]


@given(st.text(st.characters(categories=("Ll", "Lo", "Mn", "Lm", "Sk")), min_size=1, max_size=5))
def test_a_symbol_is_known_or_one_error(symbol):
    table = phone_table()
    try:
        looks = table.looks([symbol], "ipa")[0]
    except UnknownNameError:
        assert unicodedata.normalize("NFD", symbol) not in table.symbols("ipa")
    else:
        assert {name for part in looks for name, _ in part.visemes} <= set(viseme_table())


@pytest.mark.parametrize("symbol", ["xyzzy", "22", "-1", "hello", "ж", "!"])
def test_unknown_sounds_are_told(symbol):
    with pytest.raises(UnknownNameError, match="phone"):
        phone_table().looks(["p", symbol])


def test_an_unknown_alphabet_is_told():
    with pytest.raises(UnknownNameError, match="arpabet"):
        phone_table().looks(["p"], "arpabat")


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        ("shows: TH,", "shows: TTH,", "phones.4.shows"),
        ("{shows: [E, {iy: 0.8}]", "{shows: [E, {iiy: 0.8}]", "shows.1"),
        ("shows: {TH: 0.8}", "shows: {TH: 1.8}", "shows"),
        ("ipa: [θ]", "ipa: [θ, p]", "ipa.1"),
        ("ipa: [θ]", "sampa: [T]", "sampa"),
    ],
)
def test_faults_are_told_where_they_are(tmp_path, old, new, where):
    assert old in GOOD
    path = tmp_path / "phones.yaml"
    path.write_text(GOOD.replace(old, new, 1))
    assert any(where in fault.where and fault.line for fault in faults_of(path))


def test_another_table_can_be_read(tmp_path):
    path = tmp_path / "phones.yaml"
    path.write_text("phones:\n  - {shows: aa, ipa: [a]}\n")
    table = load_phones(path)
    assert [main(looks) for looks in table.looks(["a", "PP"])] == [["aa"], ["PP"]]
    assert {alphabet: len(table.symbols(alphabet)) for alphabet in ALPHABETS}["ipa"] == 1
