"""Commands of the program in a thread of their own, so that Ctrl-C and callbacks reach the caller at once."""

import atexit
import queue
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from tribound import _tribound

T = TypeVar("T")

# How long Ctrl-C waits for a run to end by itself, s.
_PATIENCE = 0.3


class Abandoned(BaseException):
    """Ends a run in the background that nobody waits for any more."""


@dataclass
class _Message:
    """What the thread of a run asks its caller for: a call, or that a value is yielded."""

    function: Callable[..., Any] | None
    arguments: tuple[Any, ...] = ()


class Work(threading.Thread, Generic[T]):
    """A command in a thread. One at a time computes in a process: MPI, PETSc and Gmsh allow no more."""

    _current: "Work[Any] | None" = None  # the last that has begun, until it ends
    _is_closed = False
    _lock = threading.Lock()  # of these two
    _computing = threading.Lock()

    def __init__(self, command: "Callable[[Work[T]], T]", prints: bool) -> None:
        super().__init__(name="tribound", daemon=True)  # _end() waits for it: the interpreter would wait for ever
        self.prints = prints
        self._command = command
        self._messages: queue.SimpleQueue[_Message | None] = queue.SimpleQueue()
        self._replies: queue.SimpleQueue[tuple[Any, BaseException | None]] = queue.SimpleQueue()
        self._is_abandoned = False
        self._has_ended = threading.Event()
        self._result: list[T] = []
        self._failure: BaseException | None = None

    def run(self) -> None:
        """The thread itself; not for callers."""
        try:
            with Work._computing:  # after the end of a run that has been abandoned
                _tribound.forget_stop()
                self.go_on()
                self._result.append(self._command(self))
        except BaseException as failure:  # passed on to the caller
            self._failure = failure
        finally:
            del self._command
            with Work._lock:
                if Work._current is self:  # kept, it would keep its result
                    Work._current = None
            self._has_ended.set()
            self._messages.put(None)

    # ---- in the thread

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """function(*arguments) in the caller's thread; what it raises ends the run."""
        return self._ask(_Message(function, arguments))

    def show(self, value: Any) -> None:
        """Has the caller yield the value."""
        self._ask(_Message(None, (value,)))

    def go_on(self) -> None:
        """Ends the run where its caller has left it."""
        if self._is_abandoned:
            raise Abandoned

    def _ask(self, message: _Message) -> Any:
        self.go_on()
        self._messages.put(message)
        value, failure = self._replies.get()
        if failure is not None:
            raise failure
        return value

    # ---- in the caller's thread

    def values(self) -> Iterator[Any]:
        """Runs the command and yields what it shows. Closed early, it ends as the program does by Ctrl-C."""
        try:
            self._claim()
            for message in iter(self._messages.get, None):
                if message.function is None:
                    yield message.arguments[0]
                    self._replies.put((None, None))
                else:
                    self._reply(message)
            self.join()
        except GeneratorExit:
            self._finish()
            raise
        finally:  # Ctrl-C may come at any line above
            if Work._current is self:
                self._leave()
        if self._failure is not None:
            try:
                raise self._failure
            finally:
                self._failure = None  # its traceback would keep this alive

    def result(self) -> T:
        """Runs the command and returns its result."""
        for _ in self.values():
            pass
        return self._result.pop()

    def _reply(self, message: _Message) -> None:
        assert message.function is not None
        try:
            value = message.function(*message.arguments)
        except Exception as failure:
            self._replies.put((None, failure))
        else:
            self._replies.put((value, None))

    def _claim(self) -> None:
        with Work._lock:
            busy = Work._current
            if Work._is_closed or (busy is not None and not busy._is_abandoned):
                raise RuntimeError(
                    "Tribound computes already in this process, and it can do one thing at a time: wait for it, "
                    "or take a process of its own for each run"
                    if busy
                    else "Tribound cannot compute any more: the interpreter ends"
                )
            _tribound.start()
            atexit.unregister(_end)
            atexit.register(_end)  # before the handlers of what the run uses, such as its temporary directory
            Work._current = self
            self.start()

    def _finish(self) -> None:
        """Waits for a run that stops after the step that it is in, with a certificate of its last level."""
        _tribound.request_stop()
        self._replies.put((None, None))
        for _ in iter(self._messages.get, None):
            self._replies.put((None, None))
        self.join()

    def _leave(self) -> None:
        """Ends the run: at once for the caller; the thread ends after the step that it is in."""
        self._is_abandoned = True
        _tribound.request_stop()
        self._replies.put((None, Abandoned()))
        self._has_ended.wait(_PATIENCE)


def _end() -> None:
    """Ends a run that the interpreter does not wait for, such as that of a generator left half-way."""
    with Work._lock:
        Work._is_closed = True
        work = Work._current
    if work is not None:
        work._leave()
    Work._computing.acquire()


def _print(text: str) -> None:
    work = Work._current
    if work is not None and work.prints:
        sys.stdout.write(text)
        sys.stdout.flush()


def _note(text: str) -> None:
    warnings.warn(f"tribound: {text}", stacklevel=2)


_tribound.set_output(_print, _note)
atexit.register(_tribound.finish)
