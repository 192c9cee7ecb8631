from __future__ import annotations

from pathlib import Path

import pytest
from tokenizers import Tokenizer
from tokenizers.models import WordLevel
from tokenizers.pre_tokenizers import Whitespace
from tokenizers.processors import TemplateProcessing

from diorama_core.errors import UnavailableError
from diorama_core.models.clip import clip_tokens, load_tokenizer, tidy

WORDS = {"<s>": 1, "</s>": 2, "a": 3, "red": 4, "chair": 5, "?": 6}


@pytest.fixture
def tokenizer(tmp_path: Path):
    made = Tokenizer(WordLevel(WORDS, unk_token="?"))
    made.pre_tokenizer = Whitespace()
    made.post_processor = TemplateProcessing(single="<s> $A </s>", special_tokens=[("<s>", 1), ("</s>", 2)])
    made.enable_padding(length=12)
    made.enable_truncation(3)
    made.save(str(tmp_path / "tokenizer.json"))
    return load_tokenizer(tmp_path / "tokenizer.json")


def test_texts_are_padded_with_zeros_and_masked(tokenizer) -> None:
    ids, mask = clip_tokens(tokenizer, ["A  RED chair", "a"], 8)
    assert ids.tolist() == [[1, 3, 4, 5, 2, 0, 0, 0], [1, 3, 2, 0, 0, 0, 0, 0]]
    assert mask.tolist() == [[1, 1, 1, 1, 1, 0, 0, 0], [1, 1, 1, 0, 0, 0, 0, 0]]


def test_long_texts_are_cut_but_keep_their_end_mark(tokenizer) -> None:
    ids, mask = clip_tokens(tokenizer, ["a red red red red red chair"], 5)
    assert ids.tolist() == [[1, 3, 4, 4, 2]]
    assert mask.sum() == 5
    assert clip_tokens(tokenizer, [], 5)[0].shape == (0, 5)


def test_texts_are_tidied_as_clip_wants_them() -> None:
    assert tidy("  A&amp;amp;B \n Chair ") == "a&b chair"


@pytest.mark.parametrize("content", [None, "{", '{"model": 3}'])
def test_a_missing_or_damaged_file_says_what_to_do(tmp_path: Path, content: str | None) -> None:
    path = tmp_path / "tokenizer.json"
    if content is not None:
        path.write_text(content)
    with pytest.raises(UnavailableError, match="diorama models verify"):
        load_tokenizer(path)
