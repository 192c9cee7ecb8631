"""A file dropped anywhere on the page goes where it belongs: a picture becomes the photo, a model joins the library."""

from __future__ import annotations

import html
import json

import viser

from diorama_app.panels.upload_field import Take, hidden_upload
from diorama_app.session.client import Client
from diorama_core.importing.forms import SUFFIXES

MODELS = ("glb", "gltf", "obj", "ply", "stl", "fbx", "dae", "3mf", "3ds", "off")
SCENES = tuple(s[1:] for s in SUFFIXES if s[1:] not in (*MODELS, "txt", "csv"))
"""A GLB may be either; dropped, it is a model, and *Open a file* takes it as a scene."""

_SCRIPT = """(()=>{const to=%s,veil=document.getElementById('dio-drop')||Object.assign(document.createElement('div'),
{id:'dio-drop',textContent:'Drop a photo of a room, a model or a scene file'});document.body.appendChild(veil);
const hold=e=>e.dataTransfer&&[...e.dataTransfer.types].includes('Files');let deep=0;
const show=on=>{veil.style.display=on?'flex':'none'};show(false);
document.ondragenter=e=>{if(hold(e)){deep++;show(true)}};
document.ondragleave=e=>{if(hold(e)&&--deep<=0){deep=0;show(false)}};
document.ondragover=e=>{if(hold(e))e.preventDefault()};
document.ondrop=e=>{if(!hold(e))return;deep=0;show(false);
if(e.target.closest&&e.target.closest('[data-file]'))return;e.preventDefault();
const file=e.dataTransfer.files[0];if(!file)return;const kind=file.name.split('.').pop().toLowerCase();
const field=document.getElementById('file_upload_'+(to[kind]||to['']));if(!field)return;
const one=new DataTransfer();one.items.add(file);field.files=one.files;
field.dispatchEvent(new Event('change',{bubbles:true}))};this.remove()})()"""

_STYLE = """<style>#dio-drop { position: fixed; inset: 12px; z-index: 950; display: none; pointer-events: none;
  align-items: center; justify-content: center; border: 3px dashed #2f6fd6; border-radius: 14px; font-size: 20px;
  color: #fff; background: #1d4f9e99; }</style>"""


def take_dropped_files(gui: viser.GuiApi, client: Client, photo: Take, model: Take, scene: Take) -> None:
    """Listen to the page for dropped files. Call it where the panel is always there: uploads go through hidden buttons.

    Args:
        gui: the page.
        client: the owner.
        photo: takes name and content of a picture, and of what is of no known kind, to say what is wrong.
        model: takes those of a model.
        scene: takes those of a scene.
    """
    fields = [hidden_upload(gui, client, "Dropped file", take) for take in (photo, model, scene)]
    to = {"": fields[0], **dict.fromkeys(MODELS, fields[1]), **dict.fromkeys(SCENES, fields[2])}
    script = html.escape(_SCRIPT.replace("\n", "") % json.dumps(to))
    gui.add_html(f'{_STYLE}<img alt="" src="data:," style="display:none" onerror="{script}">')
