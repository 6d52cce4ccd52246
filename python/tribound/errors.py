"""Exceptions: input that the user can correct, and computations that failed."""


class InputError(ValueError):
    """Bad input: names the place, what is wrong there and what would be right."""

    def __init__(
        self, message: str, file: str = "", key: str = "", line: int = 0, problem: str = "", hint: str = ""
    ) -> None:
        super().__init__(message)
        self.file = file
        self.key = key
        self.line = line
        self.problem = problem or message
        self.hint = hint

    @classmethod
    def at(cls, key: str, problem: str, hint: str = "", file: str = "case") -> "InputError":
        """The same, with the message that the program would print."""
        message = f"{file}: {key}: {problem}" + (f"\n  hint: {hint}" if hint else "")
        return cls(message, file, key, 0, problem, hint)


class SolveError(RuntimeError):
    """A computation that could not be carried out, such as one with a singular matrix."""


class WriteError(OSError):
    """A result that could not be written."""
