"""`diorama api`: rooms from photos for other programs, over HTTP.

jobs.py         a bounded queue of builds, each of which is a project on disk
access.py       who may ask, and how much may be sent
routes.py       the addresses, their arguments and answers; OpenAPI is made from them
server.py       the process
"""
