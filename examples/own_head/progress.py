"""How far the program is, on stderr: on a terminal a line while dbs works, or one JSON object per line, in
the words of dbs (docs/file-formats.md)."""
import json
import sys
import time

# Part of the time that each step takes, roughly: of a map of 1 mm at the default sizes.
SHARES = {"labels": 4, "skull, falx, mid-surface": 26, "meshes": 10, "check": 20, "procedure": 30,
          "results in the frame of the label map": 10}
PROCEDURE = ("procedure", "results in the frame of the label map")


class Progress:
    def __init__(self, style, head_only=False):
        """style: auto, line, json or none."""
        terminal = sys.stderr.isatty()
        self.style = {"auto": "line" if terminal else "none"}.get(style, style)
        self.steps = [name for name in SHARES if not (head_only and name in PROCEDURE)]
        self.start = time.monotonic()
        self.fraction = 0.0
        self.step = ""

    def begin(self, step):
        """A step begins; it may do so again."""
        self.clear()
        print(f"== {step}", flush=True)
        self.step = step
        self._advance(0.0)
        if self.style == "json":
            self._put({"event": "step begins", "step": step, **self._times()})

    def event_of_dbs(self, event):
        """Hands on what dbs told, on this program's scale."""
        self._advance(event.get("fraction", 0.0))
        if self.style == "line" and "stage" in event:
            left = self._times()["remaining_s"]
            left = "" if left is None else f", {left:.0f} s left"
            sys.stderr.write(f"\r\033[K{100 * self.fraction:3.0f} %{left}; stage {event['stage']}, "
                             f"{event['title']}: iteration {event['iteration']}, residual "
                             f"{event['residual']:.0e}")
            sys.stderr.flush()
        elif self.style == "json" and event["event"] in ("stage begins", "iteration", "stage ends"):
            self._put(event | {"step": self.step, **self._times()})

    def clear(self):
        """Takes the line away, for what is printed."""
        if self.style == "line":
            sys.stderr.write("\r\033[K")
            sys.stderr.flush()

    def end(self, event, message=None):
        """The last word. event: done, interrupted, failed or error."""
        if event == "done":
            self.fraction = 1.0
        if self.style == "json":
            said = {} if message is None else {"message": message}
            self._put({"event": event, "step": self.step, **self._times(), **said})
        elif message is not None:
            self.clear()
            print(f"own_head: {message}", file=sys.stderr)

    def _advance(self, part_of_step):
        total = sum(SHARES[name] for name in self.steps)
        before = sum(SHARES[name] for name in self.steps[:self.steps.index(self.step)])
        self.fraction = max(self.fraction, (before + part_of_step * SHARES[self.step]) / total)

    def _times(self):
        elapsed = time.monotonic() - self.start
        early = self.fraction < 0.02
        return {"fraction": self.fraction, "elapsed_s": elapsed,
                "remaining_s": None if early else elapsed * (1 - self.fraction) / self.fraction}

    @staticmethod
    def _put(event):
        sys.stderr.write(json.dumps(event) + "\n")
        sys.stderr.flush()
