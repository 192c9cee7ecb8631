"""`diorama api`: rooms from photos for other programs, over HTTP.

job.py          one build and how it is kept
jobs.py         a bounded queue of builds, each of which is a project on disk
access.py       who may ask, and how much may be sent
building.py     the build of one
answers.py      what is told of them
routes.py       the addresses, their arguments and answers; OpenAPI is made from them
connections.py  what comes before a request is whole
server.py       the process
"""
