"""`diorama api`: rooms from photos, and the rooms that are open, for other programs, over HTTP.

access.py           who may ask, how much may be sent, and what comes before a request is whole
job.py, jobs.py     one build and how it is kept; a bounded queue of builds, each of which is a project on disk
routes.py           the addresses of jobs, their arguments and answers; OpenAPI is made from them
forms.py            what is sent
answers.py          what is told of jobs and errors, pictures and files
open_projects.py    projects that are open in the editor of this process; project_answers.py says what is told of them,
                    project_routes.py has their addresses: look, ask, edit, undo
beside.py           the same beside a running editor, and how programs find it
server.py           the process
"""
