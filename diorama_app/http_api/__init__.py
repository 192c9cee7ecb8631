"""`diorama api`: rooms from photos, and the rooms that are open, for other programs, over HTTP.

job.py          one build and how it is kept
jobs.py         a bounded queue of builds, each of which is a project on disk
access.py       who may ask, and how much may be sent
building.py     the build of one
answers.py      what is told of them
photo_form.py   the form of a photo with what is known of it
files.py        pictures and files of a scene
problems.py     how errors are told
routes.py       the addresses of jobs, their arguments and answers; OpenAPI is made from them
open_projects.py    projects that are open in the editor of this process
project_forms.py    what is sent to them
project_answers.py  what is told of them
project_routes.py   their addresses: look, ask, edit, undo
beside.py       the same beside a running editor, and how programs find it
connections.py  what comes before a request is whole
server.py       the process
"""
