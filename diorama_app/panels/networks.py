"""The implementation each stage uses, and the download of better networks."""

from __future__ import annotations

import time

import viser

from diorama_app.panels.fields import enable, on_change, on_press, show_if, show_value
from diorama_app.reconstruction.networks import get_networks, missing_networks
from diorama_app.session.client import Client
from diorama_app.strings import N_, _
from diorama_app.web.html import LiveHtml, library_text, text
from diorama_core.errors import DioramaError
from diorama_core.models.manifest import networks_of
from diorama_core.models.network import Network
from diorama_core.models.store import ModelStore
from diorama_core.pipeline.choices import StageStatus, profile_status

SETS = {
    N_("micro: everyday objects, rough depth"): "micro",
    N_("tiny: a photo alone"): "tiny",
    N_("lite: fine on a laptop"): "lite",
    N_("default: better"): "default",
    N_("paper: as published"): "paper",
}

POLL_EVERY_S = 3.0


class Networks:
    """The list of stages, the choice of a set with its licences, and "Download networks"."""

    def __init__(self, gui: viser.GuiApi, client: Client) -> None:
        self._client = client
        with gui.add_folder(_("Networks"), expand_by_default=False):
            self._stages = LiveHtml(gui)
            self._choice = gui.add_dropdown(
                _("Set"), tuple(map(_, SETS)), hint=_("Networks to download; all are optional")
            )
            self._offer = LiveHtml(gui)
            self._accept = gui.add_checkbox(_("I accept these licences"), False)
            self._get = gui.add_button(
                _("Download networks"), color="blue", hint=_("Download the missing networks; this can be cancelled")
            )
        self._state: tuple[object, ...] = ()
        self._polled_at = 0.0
        on_change(self._choice, lambda _: client.post(self._choose))
        on_change(self._accept, lambda _: client.post(self.refresh))
        on_press(self._get, lambda: client.post(self._start))

    def refresh(self) -> None:
        """Draw the installed networks and those the chosen set adds; reads the disk now and then, not at every edit."""
        state = (self._choice.value, self._accept.value, self._client.session.jobs.status is None)
        if state == self._state and time.monotonic() - self._polled_at < POLL_EVERY_S:
            return
        self._state, self._polled_at = state, time.monotonic()
        store = ModelStore.default()
        self._stages.show(_stages_html())
        missing, unknown = self._missing(store), self._unknown(store)
        self._offer.show(_offer_html(missing, store))
        show_if(bool(unknown), self._accept)
        show_if(bool(missing), self._get)
        enable(self._get, self._client.session.jobs.status is None and (not unknown or self._accept.value))

    def _networks(self) -> tuple[Network, ...]:
        return networks_of(next(name for label, name in SETS.items() if _(label) == self._choice.value))

    def _missing(self, store: ModelStore) -> tuple[Network, ...]:
        return missing_networks(store, self._networks())

    def _unknown(self, store: ModelStore) -> frozenset[str]:
        """Ids of missing networks whose licences were not accepted on this machine yet."""
        return frozenset(n.id for n in self._missing(store)) - store.read_accepted_licences()

    def _choose(self) -> None:
        show_value(self._accept, False)  # another set has other licences
        self.refresh()

    def _start(self) -> None:
        accepted = self._unknown(ModelStore.default()) if self._accept.value else frozenset[str]()
        get_networks(self._client, self._networks(), accepted)


def _stages_html() -> str:
    try:
        stages = profile_status()
    except DioramaError as error:
        return f'<p class="bad">{library_text(str(error))}</p>'
    return f"<h4>{text(_('What each stage uses now'))}</h4>" + "".join(_stage_html(s) for s in stages)


def _stage_html(stage: StageStatus) -> str:
    name = library_text(stage.stage)
    if stage.network_id is None:
        about = ""
    elif stage.present:
        about = _("a network on this machine, {size}, {licence}").format(
            size=_size(stage.size_mb), licence=text(stage.licence)
        )
    else:
        about = _("no network on this machine")
    advice = text(_(stage.advice.split(": diorama models pull")[0]))
    better = _("better: {advice}").format(advice=advice) if stage.network_id is not None and advice else advice
    small = " · ".join(part for part in (about, better) if part)
    small = small[:1].upper() + small[1:]
    return f'<p><b>{name}</b>: {library_text(stage.implementation)}<br><span class="dim">{small}</span></p>'


def _offer_html(missing: tuple[Network, ...], store: ModelStore) -> str:
    if not missing:
        return f'<p class="dim">{text(_("All networks of this set are installed."))}</p>'
    total = sum(n.size_bytes for n in missing) / 1e6
    rows = "".join(
        f"<tr><td>{text(n.title)}</td><td style='white-space:nowrap'>{_size(n.size_bytes / 1e6)}<br>"
        f'<span class="dim">{text(n.licence)}</span></td></tr>'
        for n in missing
    )
    known = all(n.id in store.read_accepted_licences() for n in missing)
    words = _("Their licences were accepted on this machine.") if known else _("Their licences are accepted once.")
    size = _("{size} to download.").format(size=_size(total))
    return f'<div class="card"><b>{text(size)}</b> {text(words)}<table>{rows}</table></div>'


def _size(megabytes: float) -> str:
    return f"{megabytes / 1000:.1f} GB" if megabytes >= 1000 else f"{megabytes:.0f} MB"
