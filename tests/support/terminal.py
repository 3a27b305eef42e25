"""A program whose standard error is a terminal."""
import os
import pty
import subprocess


def said_to_terminal(command):
    """Runs it to its end: exit status, and the bytes of standard error."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen(command, stderr=theirs, stdout=subprocess.DEVNULL)
    os.close(theirs)
    said = b""
    try:
        while part := os.read(ours, 4096):
            said += part
    except OSError:  # Linux: the other end is closed
        pass
    os.close(ours)
    return process.wait(), said
