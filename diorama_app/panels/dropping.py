"""A file dropped anywhere on the page goes where it belongs: a picture becomes the photo, a model joins the library."""

from __future__ import annotations

import html
import json

import viser

PICTURES = ("jpg", "jpeg", "png", "webp", "heic", "heif", "tif", "tiff", "bmp")
MODELS = ("glb", "gltf", "obj", "ply", "stl", "fbx")

_SCRIPT = """(()=>{const to=%s,veil=document.getElementById('dio-drop')||Object.assign(document.createElement('div'),
{id:'dio-drop',textContent:'Drop a photo of a room, or a model file'});document.body.appendChild(veil);
const hold=e=>e.dataTransfer&&[...e.dataTransfer.types].includes('Files');let deep=0;
const show=on=>{veil.style.display=on?'flex':'none'};show(false);
document.ondragenter=e=>{if(hold(e)){deep++;show(true)}};document.ondragleave=e=>{if(hold(e)&&--deep<=0){deep=0;show(false)}};
document.ondragover=e=>{if(hold(e))e.preventDefault()};
document.ondrop=e=>{if(!hold(e))return;deep=0;show(false);if(e.defaultPrevented)return;e.preventDefault();
const file=e.dataTransfer.files[0];if(!file)return;const kind=file.name.split('.').pop().toLowerCase();
const [id,name]=to[kind]||to[''],one=new DataTransfer();one.items.add(file);
const tab=[...document.querySelectorAll('[role=tab]')].find(t=>t.textContent.trim()===name);if(tab)tab.click();
const give=left=>{const field=document.getElementById('file_upload_'+id);
if(!field){if(left)setTimeout(()=>give(left-1),50);return}
field.files=one.files;field.dispatchEvent(new Event('change',{bubbles:true}))};give(60)};this.remove()})()"""
"""A tab's upload button is there only once the tab has been opened: it is opened, and waited for."""

_STYLE = """<style>#dio-drop { position: fixed; inset: 12px; z-index: 950; display: none; pointer-events: none;
  align-items: center; justify-content: center; border: 3px dashed #2f6fd6; border-radius: 14px; font-size: 20px;
  color: #fff; background: #1d4f9e99; }</style>"""


def take_dropped_files(gui: viser.GuiApi, photo: tuple[str, str], model: tuple[str, str]) -> None:
    """Listen to the page for dropped files.

    Args:
        gui: the page.
        photo: id of the upload button for photos, and its tab; it also gets what is of no known kind, to say what is
            wrong.
        model: id of the upload button for models, and its tab.
    """
    to = dict.fromkeys(("", *PICTURES), photo) | dict.fromkeys(MODELS, model)
    script = html.escape(_SCRIPT.replace("\n", "") % json.dumps(to))
    gui.add_html(f'{_STYLE}<img alt="" src="data:," style="display:none" onerror="{script}">')
