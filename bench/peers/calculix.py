"""The bar by CalculiX: its deck, a run with its CPU time, what comes out."""
import os
import pty
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

FIELD = "1.E-4"   # of force and of displacement; ten times that leaves more than a millionth open
STEPS = {"automatic": ("*STATIC", 1.0), "1": ("*STATIC,DIRECT", 1.0), "2": ("*STATIC,DIRECT", 0.5),
         "5": ("*STATIC,DIRECT", 0.2), "10": ("*STATIC,DIRECT", 0.1)}


@dataclass
class Mesh:
    nodes: list   # of three coordinates each, as they stand in the file
    tets: list    # of four node numbers each, from 0

    @staticmethod
    def read(path):
        lines = Path(path).read_text().split("\n")
        nodes, tets = map(int, lines[0].split())
        return Mesh([line.split() for line in lines[1:1 + nodes]],
                    [tuple(map(int, line.split())) for line in lines[1 + nodes:1 + nodes + tets]])


def deck(mesh, bar, step):
    """*ELASTIC with NLGEOM is St. Venant-Kirchhoff. Results are written at the end only."""
    text = ["*NODE,NSET=NALL", *(f"{i + 1},{','.join(p)}" for i, p in enumerate(mesh.nodes)),
            "*ELEMENT,TYPE=C3D4,ELSET=EALL",
            *(f"{t + 1}," + ",".join(str(k + 1) for k in tet) for t, tet in enumerate(mesh.tets)),
            "*NSET,NSET=WALL", *(f"{i + 1}," for i, p in enumerate(mesh.nodes) if float(p[0]) == 0.0),
            "*BOUNDARY", "WALL,1,3",
            "*MATERIAL,NAME=TISSUE", "*ELASTIC", f"{bar['young']},{bar['poisson']}", "*DENSITY", str(bar["density"]),
            "*SOLID SECTION,ELSET=EALL,MATERIAL=TISSUE"]
    keyword, first = STEPS[step]
    text += ["*STEP,NLGEOM,INC=1000", keyword, f"{first},1.", "*CONTROLS,PARAMETERS=FIELD", f"{FIELD},{FIELD}",
             "*DLOAD", f"EALL,GRAV,{bar['gravity']},0.,0.,-1.",
             "*NODE PRINT,NSET=NALL,FREQUENCY=100000", "U", "*END STEP"]
    return "\n".join(text) + "\n"


def cpu_seconds(pid):
    """Of a process so far, system's share included."""
    words = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def lines_with_times(folder):
    """What ccx says, each line with the CPU seconds ccx had then; on a terminal, where lines come at once."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(folder)
        os.environ.update(OMP_NUM_THREADS="1", CCX_NPROC_EQUATION_SOLVER="1")
        os.execvp("ccx", ["ccx", "bar"])
    said, rest = [], b""
    try:
        while data := os.read(terminal, 65536):
            now = cpu_seconds(pid)
            *lines, rest = (rest + data).split(b"\n")
            said += [(now, line.decode(errors="replace").strip()) for line in lines]
    except OSError:   # Linux' way to say that the other end is closed
        pass
    os.close(terminal)
    os.waitpid(pid, 0)
    return said


def displacements(path):
    """The last table of the file."""
    table = path.read_text().split("displacements")[-1].split("\n")[1:]
    return [tuple(map(float, line.split()[1:])) for line in table if len(line.split()) == 4]


def run(folder, mesh, bar, step):
    """CPU seconds from the end of reading to the last convergence, increments, iterations and displacements; None
    where CalculiX finds no balance."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "bar.inp").write_text(deck(mesh, bar, step))
    (folder / "bar.dat").unlink(missing_ok=True)
    said = lines_with_times(folder)
    (folder / "log").write_text("".join(f"{t:.2f} {line}\n" for t, line in said))
    begin = [t for t, line in said if line.startswith("STEP ")]
    end = [t for t, line in said if line == "convergence"]
    finished = any(line == "Job finished" for _, line in said)
    u = displacements(folder / "bar.dat") if (folder / "bar.dat").is_file() else []
    if not (begin and end and finished and len(u) == len(mesh.nodes)) or any("*ERROR" in line for _, line in said):
        return None
    iterations = sum(bool(re.fullmatch(r"iteration \d+", line)) for _, line in said)
    return {"step": step, "increments": len(end), "seconds": end[-1] - begin[0], "iterations": iterations,
            "factorisations": iterations, "u": u}


def version():
    said = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
    spooles = subprocess.run(["dpkg-query", "-W", "-f=${Version}", "libspooles2.2"], capture_output=True, text=True,
                             check=False).stdout
    return re.search(r"Version\s+(\S+)", said)[1], spooles or "of unknown version"
