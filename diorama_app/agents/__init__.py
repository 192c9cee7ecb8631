"""`diorama mcp`: an agent's tools, over the Model Context Protocol.

api.py      asks the HTTP interface of a running editor
tools.py    the tools and resources
server.py   finds an editor or starts one, and answers over stdio or HTTP
"""
