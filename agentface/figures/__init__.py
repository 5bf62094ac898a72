"""The figures of the documents, drawn from the faces themselves."""
