"""Progress and interrupts of examples/own_head: what it says while it works, and what is left when it is
stopped."""
import json
import os
import signal
import subprocess
import unittest

from support import EXAMPLE, QUICK, WORK, Case, run, stages_of  # first: it says where the example's modules are
import progress
from terminal import said_to_terminal

LABELS = WORK / "out/phantom/labels.nii.gz"
PLAN = WORK / "out/phantom/plan_lps"
WHOLE = WORK / "out/my_head"  # the same, not interrupted
STAGES = ["0", "1", "2", "3", "4", "5", "6a", "6b", "6c", "7", "8", "9"]


class Progress(Case):
    def test_every_line_is_an_object_from_the_first_step_to_the_end(self):
        result = run(LABELS, "--plan", PLAN, "--out", self.folder / "out", *QUICK, "--progress", "json")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        events = [json.loads(line) for line in result.stderr.splitlines()]
        fractions = [event["fraction"] for event in events]
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual((fractions[0], fractions[-1], events[-1]["event"]), (0.0, 1.0, "done"))
        steps = [event["step"] for event in events if event["event"] == "step begins"]
        self.assertEqual(steps, list(progress.SHARES))
        # Within the procedure it goes on, as dbs tells it.
        for name in ("stage begins", "stage ends"):
            self.assertEqual([e["stage"] for e in events if e["event"] == name], STAGES)
        inside = {e["fraction"] for e in events if e["step"] == "procedure"}
        self.assertGreater(len(inside), 3 * len(STAGES))
        self.assertIsNotNone(events[-2]["remaining_s"])

    def test_a_refusal_is_an_object_too(self):
        result = run(self.folder / "none.nii.gz", "--out", self.folder / "out", "--progress", "json")
        self.assertEqual(result.returncode, 1)
        last = json.loads(result.stderr.splitlines()[-1])
        self.assertEqual(last["event"], "error")
        self.assertIn("none.nii.gz: cannot be read", last["message"])

    def test_a_terminal_gets_one_line_that_is_gone_in_the_end(self):
        status, said = said_to_terminal([EXAMPLE / "run", LABELS, "--plan", PLAN, "--out", self.folder / "out", *QUICK])
        self.assertEqual(status, 0)
        self.assertNotIn(b"\n", said)
        self.assertRegex(said, rb"\d\d %, \d+ s left; stage 5, right, cannula out: iteration \d")
        self.assertTrue(said.endswith(b"\r\x1b[K"), said[-80:])

    def test_quiet_is_silent_even_so(self):
        result = run(LABELS, "--out", self.folder / "out", *QUICK, "--head-only", "--quiet", "--progress", "json")
        self.assertEqual((result.returncode, result.stderr), (0, ""))


class Interrupts(Case):
    def stop_when(self, reached, number, group=False):
        """Runs the procedure and sends a signal at the first event for which reached(event) holds: to the
        program, or, as a terminal does it, to all of its group. Exit status, events."""
        command = [EXAMPLE / "run", LABELS, "--plan", PLAN, "--out", self.folder / "out", *QUICK, "--progress",
                   "json"]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                   start_new_session=True)
        events, sent = [], False
        for line in process.stderr:
            events.append(json.loads(line))
            if not sent and reached(events[-1]):
                os.killpg(process.pid, number) if group else process.send_signal(number)
                sent = True
        process.stderr.close()
        return process.wait(), events

    def assert_results_of(self, count):
        """Tables, meshes and fields are there, of the first stages, and are those of the whole run."""
        out = self.folder / "out"
        self.assertEqual(stages_of(out), stages_of(WHOLE)[:count])
        meshes = {f"stage_{label}.vtu" for label in STAGES[:count]}
        self.assertEqual({path.name for path in (out / "image").glob("*.vtu")}, meshes)
        for name in meshes:
            self.assertEqual((out / "image" / name).read_bytes(), (WHOLE / "image" / name).read_bytes(), name)
        fields = {f"stage_{label}.displacement.nii.gz" for label in STAGES[:count][-2:]}
        self.assertEqual({path.name for path in (out / "image").glob("*.nii.gz")}, fields)
        self.assertIn("interrupted in stage", (out / "procedure/table.txt").read_text(encoding="utf-8"))
        self.assertEqual([path.name for path in self.folder.iterdir()], ["out"])

    def test_ctrl_c_keeps_the_finished_stages_and_what_is_made_of_them(self):
        status, events = self.stop_when(
            lambda e: (e["event"], e.get("stage")) == ("iteration", "4"), signal.SIGINT, group=True)
        self.assertEqual(status, 130)
        self.assertEqual(events[-1]["event"], "interrupted")
        self.assertIn("has what was finished", events[-1]["message"])
        self.assert_results_of(4)

    def test_sigterm_does_the_same(self):
        status, _ = self.stop_when(
            lambda e: (e["event"], e.get("stage")) == ("iteration", "1"), signal.SIGTERM)
        self.assertEqual(status, 128 + signal.SIGTERM)
        self.assert_results_of(1)

    def test_before_the_first_stage_an_earlier_result_stays(self):
        out = self.folder / "out"
        out.mkdir()
        (out / "own_head.json").write_text("{}")
        status, events = self.stop_when(
            lambda e: e.get("step") == "skull, falx, mid-surface", signal.SIGINT, group=True)
        self.assertEqual(status, 130)
        self.assertIn("nothing was written", events[-1]["message"])
        self.assertEqual([path.name for path in out.iterdir()], ["own_head.json"])
        self.assertEqual([path.name for path in self.folder.iterdir()], ["out"])

    def test_a_field_of_a_stage_that_cannot_be_is_refused_before_anything_is_done(self):
        self.assert_refused(LABELS, "--fields", "8,10", says=["--fields 8,10", "no stage '10'", "6a"])


if __name__ == "__main__":
    unittest.main(verbosity=2)
