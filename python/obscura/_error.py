"""The exception of the package."""


class Error(Exception):
    """What the library refused, or could not do.

    id: stable, for programs: 'E-CAM-UNKNOWN'; docs/errors.md lists them all.
    place: a file, with a JSON pointer into it, or the setting that was given.
    text: for people: what is wrong and what would be accepted.
    code: the exit code of the program obscura for it.
    also: further Errors that were found together with this one.
    """

    def __init__(self, id, place, text, code=70, also=()):
        super().__init__(id, place, text, code, also)
        self.id = id
        self.place = place
        self.text = text
        self.code = code
        self.also = tuple(also)

    def __str__(self):
        head = f"{self.place}: " if self.place else ""
        lines = [f"{head}{self.text} [{self.id}]"]
        lines += [str(other) for other in self.also]
        return "\n".join(lines)
