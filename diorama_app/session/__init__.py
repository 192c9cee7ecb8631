"""One open document and the people who edit it."""
