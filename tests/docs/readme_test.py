"""The C++ lines of the README are built against the installed package as they stand there, and run on the arrays
of readme_frame.hpp: every solve in them finds its balance, and the lead and the target have moved.

    readme_test.py --prefix PREFIX --work FOLDER"""
import argparse
import pathlib
import shutil
import subprocess
import sys

from documents import SOURCE, parse, read

PROJECT = """cmake_minimum_required(VERSION 3.22)
project(readme LANGUAGES C CXX)
find_package(brainshift 0.1 REQUIRED COMPONENTS core)
add_executable(readme readme.cpp)
target_compile_features(readme PRIVATE cxx_std_17)
target_compile_options(readme PRIVATE -Wall -Wextra)
target_include_directories(readme PRIVATE {folders})
target_link_libraries(readme PRIVATE brainshift::brainshift)
"""

PROGRAM = """{top}
#include "readme_frame.hpp"
using namespace frame;

int main() try {{
{lines}
  const bool moved = shift.values.norm() > 0.0 && now.bow > 0.0 && now.nodes.allFinite();
  std::printf("target moved by %.3f mm, bow %.3f mm\\n", shift.values.norm(), now.bow);
  return moved && stepper.solve_static().converged() ? 0 : 1;
}} catch (const brainshift::Error& error) {{
  return fail(error.what());
}}
"""


def program():
    block = next(b for b in parse(read("README.md"))[0] if b.language == "cpp")
    top = [line for line in block.lines if line.startswith(("#include", "using namespace"))]
    rest = [line for line in block.lines if line not in top]
    return PROGRAM.format(top="\n".join(top), lines="\n".join(rest))


def main():
    parser = argparse.ArgumentParser()
    for option in ("--prefix", "--work"):
        parser.add_argument(option, required=True)
    arguments = parser.parse_args()
    work = pathlib.Path(arguments.work)
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    folders = f"{SOURCE / 'examples'} {SOURCE / 'tests/docs'}"
    (work / "CMakeLists.txt").write_text(PROJECT.format(folders=folders), encoding="utf-8")
    (work / "readme.cpp").write_text(program(), encoding="utf-8")
    for command in (["cmake", "-S", work, "-B", work / "build", f"-DCMAKE_PREFIX_PATH={arguments.prefix}"],
                    ["cmake", "--build", work / "build"], [work / "build/readme"]):
        if subprocess.run(command).returncode != 0:
            sys.exit(f"failed: {' '.join(map(str, command))}")


if __name__ == "__main__":
    main()
