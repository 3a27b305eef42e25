"""Every command of every document is executed by something, and commands.txt says by what.

    commands_test.py BINARY DBS    the folder of the build, its program dbs"""
import os
import re
import shlex
import subprocess
import sys
import unittest

from commands import all_commands, hidden_commands, is_command, listed
from documents import SOURCE, documents, in_backticks, parse, read

BINARY = DBS = ""
HOW = {"as", "ci", "ci:", "ctest", "here", "here:", "long", "long:", "tests", "top", "within"}


def tests_of_build(*options):
    listing = subprocess.run(["ctest", "--test-dir", BINARY, "-N", *options], capture_output=True, text=True).stdout
    return re.findall(r"Test +#\d+: (\S+)", listing)


class Commands(unittest.TestCase):
    def of_kind(self, *kinds):
        return [(command, argument) for command, (how, argument) in listed().items() if how in kinds]

    def test_all_are_listed(self):
        missing = {c: places for c, places in all_commands().items() if c not in listed()}
        self.assertEqual(missing, {}, "tests/docs/commands.txt must say what runs them")

    def test_all_that_are_listed_stand_in_a_document(self):
        self.assertEqual(set(listed()) - set(all_commands()), set(), "no document has these any more")

    def test_none_stand_outside_of_sh_blocks(self):
        self.assertEqual([(str(path), *found) for path in documents() for found in hidden_commands(path)], [])

    def test_each_says_in_a_known_way_what_runs_it(self):
        self.assertEqual({how for how, _ in listed().values()} - HOW, set())

    def test_continuous_integration_has_its_lines(self):
        lines = [" ".join(line.split()) for line in (SOURCE / ".ci/run").read_text("utf-8").splitlines()]
        for command, argument in self.of_kind("ci", "ci:"):
            self.assertIn(argument or command, lines, command)
            self.assertEqual((argument or command).split()[0], command.split()[0], "another program")

    def test_continuous_integration_is_the_only_one_that_nothing_runs(self):
        self.assertEqual([command for command, _ in self.of_kind("top")], [".ci/run"])

    def test_named_tests_are_in_the_build(self):
        names = set(tests_of_build())
        self.assertGreater(len(names), 50)
        for command, name in self.of_kind("ctest"):
            skipped = name.partition(".")[0]   # a group that cannot run here is one test, which says why
            self.assertTrue(name in names or skipped in names, f"{command}: there is no test {name}")

    def test_those_of_the_test_runner_select_some(self):
        if any(name.endswith("_NOT_BUILT") for name in tests_of_build()):
            self.skipTest("not all test programs are built")
        for command, _ in self.of_kind("tests"):
            words = shlex.split(command)
            self.assertEqual(words[0], "tests/run", command)
            options = [word for word in words[1:] if word not in ("--all", "-V")]
            self.assertGreater(len(tests_of_build(*options)), 0, command)

    def test_scripts_hold_what_is_said_to_be_within_them(self):
        for command, script in self.of_kind("within"):
            self.assertTrue(os.access(SOURCE / script, os.X_OK), script)
            text = (SOURCE / script).read_text("utf-8").replace('"', "").replace("$root/", "")
            self.assertIn(command, text, script)
            self.assertTrue(any(other.startswith(script) for other in listed()), f"{script} is run by nothing")

    def test_those_that_are_run_as_another_name_the_same_program(self):
        for command, other in self.of_kind("as"):
            self.assertIn(other, listed(), command)
            self.assertNotEqual(listed()[other][0], "as", other)
            self.assertEqual(other.split()[0], command.split()[0], command)

    def test_short_ones_succeed(self):
        for command, other in self.of_kind("here", "here:"):
            with self.subTest(command):
                result = subprocess.run(["bash", "-euo", "pipefail", "-c", other or command], cwd=SOURCE, text=True,
                                        capture_output=True, env=os.environ | {"BINARY": BINARY})
                self.assertEqual(result.returncode, 0, f"{other or command}\n{result.stdout}{result.stderr}")

    def test_options_of_dbs_that_are_named_exist(self):
        known = set(re.findall(r"--[a-z][a-z-]*", subprocess.run([DBS, "--help"], capture_output=True,
                                                                 text=True).stdout))
        self.assertGreater(len(known), 40)
        for path in documents():
            for line, text in in_backticks(parse(read(path))[1]):
                if text.startswith("dbs "):
                    named = set(re.findall(r"(?<= )--[a-z][a-z-]*", text))
                    self.assertEqual(named - known, set(), f"{path}:{line}")

    def test_what_is_a_command(self):
        self.assertTrue(is_command("examples/run --coarse"))
        self.assertTrue(is_command("X=1 cmake --version"))
        self.assertFalse(is_command("cmake"))              # the program, not a call of it
        self.assertFalse(is_command("examples/hello.c"))
        self.assertFalse(is_command("src/linear/cholmod/"))


if __name__ == "__main__":
    DBS, BINARY = sys.argv.pop(2), sys.argv.pop(1)
    unittest.main()
