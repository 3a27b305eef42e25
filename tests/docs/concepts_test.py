"""Arrays and phases of docs/concepts.md are those of the headers, with their units."""
import re
import unittest

from documents import SOURCE, read

HEADERS = "\n".join(p.read_text(encoding="utf-8") for p in sorted((SOURCE / "include/brainshift").glob("*.hpp")))


def section(heading):
    return read("docs/concepts.md").split(f"\n## {heading}\n")[1].split("\n## ")[0]


def struct(name):
    return re.search(rf"\nstruct {name} {{(.*?)\n}};", HEADERS, re.S)[1]


def rows():
    return [[cell.strip() for cell in line.strip("|").split("|")]
            for line in section("State").splitlines() if line.startswith("| `")]


class Concepts(unittest.TestCase):
    def test_every_array_of_the_table_is_in_the_headers(self):
        for name, *_ in rows():
            owner, _, member = name.strip("`").rpartition("::")
            where = struct(owner) if owner else HEADERS
            self.assertRegex(where, rf"\b{re.escape(member.strip('()'))}\b", name)

    def test_every_array_of_the_stepper_is_in_the_table(self):
        stepper = re.search(r"\nclass Stepper {(.*?)\n};", HEADERS, re.S)[1]
        arrays = set(re.findall(r"^  (?:const )?(?:Points|Eigen::VectorXd)&? (\w+)\(\) const;", stepper, re.M))
        self.assertGreater(len(arrays), 8)
        self.assertEqual(arrays - {row[0].strip("`()") for row in rows()}, set())

    def test_every_array_of_the_states_is_in_the_table(self):
        for name in ("CompartmentState", "ContactState", "DeviceState"):
            members = set(re.findall(r"^  (?:double|Points|Eigen::VectorXd|std::vector<Mat3>|Vec3) (\w+);",
                                     struct(name), re.M)) - {"bow_direction"}
            self.assertGreater(len(members), 2)
            self.assertEqual({f"`{name}::{m}`" for m in members} - {row[0] for row in rows()}, set())

    def test_units_are_those_of_the_headers(self):
        said = 0
        for name, _, unit, _ in rows():
            member = name.strip("`()").rpartition("::")[2]
            line = re.search(rf"\b{member}(?:\(\) const)?;\s*// (.*)", HEADERS)
            units = re.findall(r"\b(mm\^3|mm/s|mm|kPa|mN)\b", line[1]) if line else []
            if units:
                said += 1
                self.assertEqual(unit, units[0].replace("^3", "³"), name)
        self.assertGreater(said, 8)

    def test_phases_are_those_of_the_header(self):
        phases = re.search(r"enum class StepPhase {(.*?)};", HEADERS, re.S)[1]
        first_cells = [line.split("|")[1] for line in section("Stages and phases").split("| phase |")[1].splitlines()
                       if line.startswith("| ")]
        self.assertEqual(sorted(re.findall(r"\w+", " ".join(first_cells))),
                         sorted(re.findall(r"^  (\w+)", phases, re.M)))


if __name__ == "__main__":
    unittest.main()
