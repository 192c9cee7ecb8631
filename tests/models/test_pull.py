from __future__ import annotations

import errno
import hashlib
import re
import shutil
from collections import namedtuple
from collections.abc import Iterator
from pathlib import Path

import pytest

from diorama_core.errors import Cancelled, DioramaError, InputError, UnavailableError
from diorama_core.models.manifest import NETWORKS, network, networks_of
from diorama_core.models.network import TIERS, ModelFile, Network
from diorama_core.models.pull import pull
from diorama_core.models.store import ModelStore, default_folder
from diorama_core.progress import SILENT, CancelToken, Progress, ProgressEvent
from tests.models.stub_hub import SHA, Hub, serving, try_again_at_once

GRAPH = bytes(range(256)) * 4000
"""About a megabyte, so that a transfer takes several chunks."""
TOKENS = b'{"words": []}'


def _sha(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _network(**changes: object) -> Network:
    given: dict[str, object] = {
        "id": "small",
        "role": "detection",
        "title": "Small net",
        "licence": "MIT",
        "repo": "owner/name",
        "revision": SHA,
        "files": (ModelFile("onnx/model.onnx", len(GRAPH), _sha(GRAPH)), ModelFile("tokenizer.json")),
        "tiers": ("lite",),
    }
    return Network(**{**given, **changes})


@pytest.fixture
def hub(monkeypatch: pytest.MonkeyPatch) -> Iterator[Hub]:
    files = {"owner/name/onnx/model.onnx": GRAPH, "owner/name/tokenizer.json": TOKENS, "plain/net.onnx": GRAPH}
    with serving(Hub(files)) as running:
        monkeypatch.setenv("HF_ENDPOINT", running.address)
        yield running


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModelStore:
    try_again_at_once(monkeypatch)
    return ModelStore(tmp_path / "models")


def _pull(store: ModelStore, *networks: Network, progress: Progress = SILENT) -> tuple[str, ...]:
    return pull(store, networks, accept=lambda _: True, progress=progress)


def _fails(store: ModelStore, wanted: Network, kind: type[DioramaError] = UnavailableError) -> str:
    """The message of a pull that fails; nothing of the network can be used afterwards."""
    with pytest.raises(kind) as error:
        _pull(store, wanted)
    assert not store.has(wanted)
    with pytest.raises(UnavailableError):
        store.path(wanted, "onnx/model.onnx")
    message = str(error.value)
    assert "\n" not in message
    return message


def test_a_network_is_fetched_checked_and_used_by_path(hub: Hub, store: ModelStore) -> None:
    events: list[ProgressEvent] = []
    assert _pull(store, _network(), progress=Progress(events.append)) == ("small",)
    assert store.path(_network(), "onnx/model.onnx").read_bytes() == GRAPH
    assert store.path(_network(), "tokenizer.json").read_bytes() == TOKENS
    fractions = [e.fraction for e in events]
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0
    assert any("MB" in e.message for e in events)
    assert store.check(_network()).state == "ok"
    assert _pull(store, _network()) == ()


def test_licences_are_shown_once_and_a_refusal_fetches_nothing(hub: Hub, store: ModelStore) -> None:
    asked: list[str] = []

    def accept(answer: bool):
        return lambda networks: asked.extend(n.id for n in networks) or answer

    with pytest.raises(InputError, match="licence"):
        pull(store, [_network()], accept=accept(False))
    assert not store.has(_network())
    pull(store, [_network()], accept=accept(True))
    store.forget(_network())
    pull(store, [_network()], accept=accept(False))
    assert asked == ["small", "small"]
    assert store.has(_network())


def test_a_cut_connection_is_resumed_where_it_stopped(hub: Hub, store: ModelStore) -> None:
    hub.cut_after = [600_000]
    _pull(store, _network())
    assert store.path(_network(), "onnx/model.onnx").read_bytes() == GRAPH
    assert any(int(r.removeprefix("bytes=").split("-")[0]) > 0 for r in hub.ranges)


def test_an_unreachable_hub_leaves_what_arrived_for_the_next_try(hub: Hub, store: ModelStore) -> None:
    hub.cut_after = [600_000] + [0] * 20
    said = _fails(store, _network())
    assert "resumes" in said
    hub.cut_after, hub.ranges = [], []
    _pull(store, _network())
    assert store.has(_network())
    assert int(hub.ranges[0].removeprefix("bytes=").split("-")[0]) > 0


def test_wrong_bytes_are_never_used(hub: Hub, store: ModelStore) -> None:
    hub.corrupt = True
    assert "wrong content" in _fails(store, _network())
    hub.corrupt = False
    _pull(store, _network())
    assert store.path(_network(), "onnx/model.onnx").read_bytes() == GRAPH


def test_slow_bytes_arrive_and_can_be_cancelled(hub: Hub, store: ModelStore) -> None:
    hub.pause_s = 0.002
    token = CancelToken()

    def stop_soon(event: ProgressEvent) -> None:
        if "MB" in event.message:
            token.cancel()

    with pytest.raises(Cancelled):
        _pull(store, _network(), progress=Progress(stop_soon, token))
    assert not store.has(_network())
    _pull(store, _network())
    assert store.has(_network())


@pytest.mark.parametrize(("status", "word"), [(401, "HF_TOKEN"), (403, "HF_TOKEN"), (404, "404"), (500, "500")])
def test_refusals_say_what_to_do(hub: Hub, store: ModelStore, status: int, word: str) -> None:
    hub.status = status
    assert word in _fails(store, _network())


def test_no_network_is_one_line(store: ModelStore, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HF_ENDPOINT", "http://127.0.0.1:9")
    assert "HTTPS_PROXY" in _fails(store, _network())


def test_offline_is_respected(hub: Hub, store: ModelStore, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("huggingface_hub.constants.HF_HUB_OFFLINE", True)
    assert "HF_HUB_OFFLINE" in _fails(store, _network())
    assert "HF_HUB_OFFLINE" in _fails(store, _network(repo="", url=f"{hub.address}/plain", files=(_PLAIN,)))


_PLAIN = ModelFile("net.onnx", len(GRAPH), _sha(GRAPH))


def test_a_plain_address_is_resumed_and_checked_too(hub: Hub, store: ModelStore) -> None:
    plain = _network(repo="", url=f"{hub.address}/plain", files=(_PLAIN,))
    hub.cut_after = [500_000]
    _pull(store, plain)
    assert store.path(plain, "net.onnx").read_bytes() == GRAPH
    assert hub.ranges


def test_too_small_a_disk_is_told_before_anything_is_fetched(
    hub: Hub, store: ModelStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    usage = namedtuple("usage", "total used free")
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage(10**9, 10**9, 1000))
    assert "free" in _fails(store, _network())
    assert not hub.ranges


def test_a_disk_that_fills_up_is_one_line(hub: Hub, store: ModelStore, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*args: object, **kwargs: object) -> str:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("huggingface_hub.file_download.http_get", full)
    assert "No space left" in _fails(store, _network())


def test_an_unpinned_revision_is_resolved_and_recorded(hub: Hub, store: ModelStore) -> None:
    for revision in (None, "points-and-boxes"):
        unpinned = _network(id=f"small-{revision}", revision=revision)
        _pull(store, unpinned)
        assert store.record(unpinned).revision == SHA


def test_without_a_published_checksum_later_downloads_are_supported_to_the_first(hub: Hub, store: ModelStore) -> None:
    unpublished = _network(files=(ModelFile("onnx/model.onnx", len(GRAPH)), ModelFile("tokenizer.json", len(TOKENS))))
    assert unpublished.check_words.startswith("size checked; unverified (no published checksum)")
    assert _network().check_words.startswith("unverified")
    assert _network(files=(_PLAIN,)).check_words == "published checksum"
    _pull(store, unpublished)
    store.forget(unpublished)
    hub.corrupt = True
    assert "the first download had" in _fails(store, unpublished)
    hub.corrupt = False
    _pull(store, unpublished)
    assert store.check(unpublished).state == "ok"


def test_retries_are_told_as_progress_and_print_nothing(
    hub: Hub, store: ModelStore, capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    hub.cut_after = [600_000, 200_000]
    events: list[ProgressEvent] = []
    _pull(store, _network(), progress=Progress(events.append))
    assert sum("was cut, going on" in e.message for e in events) == 2
    assert capfd.readouterr() == ("", "")
    assert caplog.text == ""
    fractions = [e.fraction for e in events]
    assert fractions == sorted(fractions)


@pytest.mark.parametrize("damage", ["cut off", "changed"])
def test_files_damaged_later_are_found(hub: Hub, store: ModelStore, damage: str) -> None:
    _pull(store, _network())
    path = store.folder_of(_network()) / "onnx/model.onnx"
    path.write_bytes(GRAPH[:-10] if damage == "cut off" else GRAPH[::-1])
    assert damage in store.check(_network()).state
    assert store.has(_network()) == (damage == "changed")


def test_files_fetched_elsewhere_are_taken_up_when_their_content_is_right(
    tmp_path: Path, store: ModelStore, shared: Path
) -> None:
    with pytest.raises(InputError, match="no file there"):
        store.add_folder(tmp_path)
    assert store.add_folder(shared / "models") == ("yolox-nano", "fast-depth")
    assert store.has(network("yolox-nano"))
    bad = tmp_path / "bad"
    bad.mkdir()
    (bad / "lama_fp32.onnx").write_bytes(b"not lama")
    with pytest.raises(
        InputError, match=r"lama_fp32.onnx is not LaMa's published file \(another version, or damaged\)"
    ):
        store.add_folder(bad)


def test_files_are_recognised_under_other_names_and_in_their_networks_own_folder(
    tmp_path: Path, store: ModelStore, shared: Path
) -> None:
    renamed = tmp_path / "downloads"
    renamed.mkdir()
    (renamed / "detector (1).onnx").write_bytes((shared / "models" / "yolox_nano.onnx").read_bytes())
    own = tmp_path / "slimsam"
    own.mkdir()
    for name in ("vision_encoder.onnx", "prompt_encoder_mask_decoder.onnx"):
        (own / name).write_bytes(b"a graph")
    loose = tmp_path / "loose"
    loose.mkdir()
    (loose / "vision_encoder.onnx").write_bytes(b"a graph")
    with pytest.raises(InputError, match=r"vision_encoder.onnx has no published checksum .* put it in a folder named"):
        store.add_folder(loose)
    assert store.add_folder(own) == ("slimsam",)
    assert store.add_folder(renamed) == ("yolox-nano",)


def test_folders_follow_the_hubs_variables(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv("DIORAMA_MODELS", raising=False)
    monkeypatch.setenv("HF_HOME", str(tmp_path / "hub"))
    assert default_folder() == tmp_path / "hub" / "diorama"
    monkeypatch.setenv("DIORAMA_MODELS", str(tmp_path / "own"))
    assert default_folder() == tmp_path / "own"


def test_the_manifest_is_consistent() -> None:
    ids = [n.id for n in NETWORKS]
    assert len(set(ids)) == len(ids)
    for known in NETWORKS:
        assert known.size_bytes > 0
        assert not (known.tiers and not known.pullable)
        assert all(f.sha256 is None or len(f.sha256) == 64 for f in known.files)
    needed = {"detection", "segmentation", "geometry"}
    more = {"inpainting", "text and image"}
    for tier in ("tiny", "lite", "default", "paper"):
        roles = needed if tier == "tiny" else needed | more
        assert roles <= {n.role for n in networks_of(tier)}
    assert sum(n.size_bytes for n in networks_of("tiny")) < 400e6
    sizes = [sum(n.size_bytes for n in networks_of(tier)) for tier in TIERS]
    assert sizes == sorted(sizes)
    with pytest.raises(InputError, match="models list"):
        network("nothing")


def test_the_manual_tells_the_true_sizes_of_the_sets() -> None:
    manual = (Path(__file__).parents[2] / "docs" / "models.md").read_text()
    for tier in TIERS:
        told = re.search(rf"models pull {tier} +# ([\d.]+) (MB|GB)", manual)
        assert told is not None, tier
        told_bytes = float(told[1]) * {"MB": 1e6, "GB": 1e9}[told[2]]
        assert told_bytes == pytest.approx(sum(n.size_bytes for n in networks_of(tier)), rel=0.03), tier
