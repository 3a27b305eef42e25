"""Ctrl-C and SIGTERM: what they do depends on what is being done."""
import contextlib
import signal

number = 0       # of the last signal; 0: none came
_handler = None  # None: a signal ends the program by KeyboardInterrupt


def catch():
    for which in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(which) != signal.SIG_IGN:  # nohup, background jobs
            signal.signal(which, _came)


def _came(which, _):
    global number
    number = which
    if _handler is None:
        raise KeyboardInterrupt
    _handler(which)


@contextlib.contextmanager
def handled_by(handler):
    """Within it a signal calls handler(number) and the program goes on."""
    global _handler
    before, _handler = _handler, handler
    try:
        yield
    finally:
        _handler = before


def exit_status():
    """Tells a shell of it: 130 after Ctrl-C."""
    return 128 + number
