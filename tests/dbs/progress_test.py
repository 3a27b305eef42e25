"""Progress and interrupts of dbs: what it says while it works, and what is left when it is stopped.

    progress_test.py DBS HEAD"""
import csv
import json
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from terminal import said_to_terminal

DBS, HEAD = sys.argv[1:3]
STAGES = ["0", "1", "2", "3", "4", "5", "6a", "6b", "6c", "7", "8", "9"]
# A coarse solve looks up after every Newton iteration, 0.1 to 0.3 s; the rest is for a busy machine.
SECONDS_TO_END = 3.0


def command(out, *options):
    return [DBS, "--head", HEAD, "--out", str(out), *options]


def stop_when(reached, out, *options, number=signal.SIGINT):
    """Runs dbs and sends it a signal at the first event for which reached(event) holds."""
    process = subprocess.Popen(command(out, "--progress", "json", *options), text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    events, sent = [], None
    for line in process.stderr:
        events.append(json.loads(line))
        if sent is None and reached(events[-1]):
            process.send_signal(number)
            sent = time.monotonic()
    said = process.stdout.read()
    status = process.wait()
    process.stdout.close()
    process.stderr.close()
    return status, events, said, time.monotonic() - (sent or float("nan"))


def stages_of(folder):
    return json.loads((folder / "stages.json").read_text())["stages"]


def without_times(stages):
    for stage in stages:
        del stage["solve"]["seconds"]
    return stages


class Progress(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.whole = Path(cls.folder.name) / "whole"
        cls.completed = subprocess.run(command(cls.whole, "--progress", "json"), text=True,
                                 capture_output=True)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def out(self):
        return Path(self.folder.name) / self.id().split(".")[-1]

    def events(self):
        return [json.loads(line) for line in self.completed.stderr.splitlines()]

    def test_every_line_is_an_object_and_the_fraction_never_falls(self):
        self.assertEqual(self.completed.returncode, 0)
        events = self.events()
        fractions = [e["fraction"] for e in events]
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual((fractions[0], fractions[-1], events[-1]["event"]), (0.0, 1.0, "done"))
        self.assertGreater(len(set(fractions)), 3 * len(STAGES))   # within stages too
        for event in events:
            self.assertTrue(event["remaining_s"] is None or event["remaining_s"] >= 0.0)
        self.assertIsNotNone(events[len(events) // 2]["remaining_s"])

    def test_every_stage_is_announced_once_and_ended_once(self):
        for name in ("stage begins", "stage ends"):
            self.assertEqual([e["stage"] for e in self.events() if e["event"] == name], STAGES)

    def test_an_iteration_is_told_for_each_that_was_done(self):
        for stage in stages_of(self.whole):
            told = [e for e in self.events() if (e["event"], e["stage"]) == ("iteration", stage["stage"])]
            self.assertEqual(len(told), stage["solve"]["newton_iterations"])

    def test_nothing_is_said_where_stderr_is_no_terminal(self):
        run = subprocess.run(command(self.out(), "--no-vtk"), capture_output=True)
        self.assertEqual((run.returncode, run.stderr), (0, b""))

    def test_a_terminal_gets_one_line_that_is_gone_in_the_end(self):
        status, said = said_to_terminal(command(self.out(), "--no-files"))
        self.assertEqual(status, 0)
        self.assertNotIn(b"\n", said)
        self.assertRegex(said, rb" 4\d %, \d+ s left; stage 5, right, cannula out: iteration \d")
        self.assertTrue(said.endswith(b"\r\x1b[K"), said[-80:])

    def test_quiet_is_silent_even_so(self):
        run = subprocess.run(command(self.out(), "--no-files", "--quiet", "--progress", "json",
                                     "--no-devices"), capture_output=True)
        self.assertEqual((run.returncode, run.stderr), (0, b""))

    def test_an_error_is_an_object_too(self):
        run = subprocess.run(command(self.out(), "--progress", "json", "--young", "0"),
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 1)
        event = json.loads(run.stderr)
        self.assertEqual(event["event"], "error")
        self.assertIn("young", event["message"])

    def test_an_interrupt_leaves_the_finished_stages_whole(self):
        out = self.out()
        status, events, said, seconds = stop_when(
            lambda e: (e["event"], e["stage"]) == ("iteration", "4") and e["iteration"] == 2, out)
        self.assertEqual(status, 130)
        self.assertLess(seconds, SECONDS_TO_END)
        self.assertEqual((events[-1]["event"], events[-1]["stage"]), ("interrupted", "4"))
        self.assertIn("interrupted in stage 4 (right, testing)", said)
        # The tables: those of the first four stages, to the last digit.
        whole = without_times(stages_of(self.whole))
        self.assertEqual(without_times(stages_of(out)), whole[:4])
        for name in ("stages.csv", "electrodes.csv"):
            with open(out / name, newline="") as some, open(self.whole / name, newline="") as all_of_it:
                finished = [r for r in csv.DictReader(all_of_it) if r["stage"] in STAGES[:4]]
                rows = list(csv.DictReader(some))
            for row in finished + rows:
                row.pop("seconds", None)
            self.assertEqual(rows, finished)
            self.assertGreater(len(rows), 0)
        # The files: those of the whole run, byte for byte, and no others.
        expected = {p.name for p in self.whole.glob("stage_[0-3]*")}
        self.assertEqual({p.name for p in out.glob("stage_*")}, expected)
        for name in expected:
            self.assertEqual((out / name).read_bytes(), (self.whole / name).read_bytes(), name)
        for series in ("stages.pvd", "stages.electrodes.pvd"):
            listed = {e.get("file") for e in xml.etree.ElementTree.parse(out / series).iter("DataSet")}
            self.assertTrue(listed and listed <= expected, listed)
        self.assertEqual(list(out.glob("*.part")), [])

    def test_sigterm_does_the_same(self):
        out = self.out()
        status, *_ = stop_when(lambda e: (e["event"], e["stage"]) == ("iteration", "1"), out,
                               number=signal.SIGTERM)
        self.assertEqual(status, 128 + signal.SIGTERM)
        self.assertEqual([s["stage"] for s in stages_of(out)], ["0"])

    def test_an_interrupted_search_keeps_the_choices_it_has_tried(self):
        out = self.out()
        status, events, said, seconds = stop_when(
            lambda e: e["procedure"] == 2 and e["event"] == "iteration", out, "--plan", "--sides", "right")
        self.assertEqual(status, 130)
        self.assertLess(seconds, SECONDS_TO_END)
        fractions = [e["fraction"] for e in events]
        self.assertEqual(fractions, sorted(fractions))
        self.assertLess(fractions[-1], 0.5)
        self.assertIn("interrupted after 1 choice", said)
        self.assertEqual(len(json.loads((out / "plan.json").read_text())["alternatives"]), 1)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
