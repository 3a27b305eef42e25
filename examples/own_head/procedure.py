"""Runs dbs on the head; hands on its table, its progress and interrupts."""
import json
import subprocess
import threading

import interrupts
from problem import Problem


def command(options, folder, sides):
    words = [options.dbs, "--head", folder / "head", "--out", folder / "procedure", "--progress", "json"]
    return words + (["--sides", sides[0]] if len(sides) == 1 else []) + options.dbs_options


def operate(options, folder, sides, progress):
    """The table goes to the screen and to procedure/table.txt. Returns dbs's exit code: 0, 2 where a stage
    found no balance, 128 + number after a signal; then the stages that were finished are there."""
    (folder / "procedure").mkdir()
    lines, said = [], []
    process = None

    def hand_on(number):
        if process is not None:
            process.send_signal(number)

    def listen():
        for line in process.stderr:
            hear(line, said, progress)

    with interrupts.handled_by(hand_on):
        # In a session of its own: Ctrl-C comes to this program alone, which hands it on once.
        process = subprocess.Popen(command(options, folder, sides), stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True, start_new_session=True)
        if interrupts.number:  # came while it was started
            process.send_signal(interrupts.number)
        listener = threading.Thread(target=listen)
        listener.start()
        with process:
            for line in process.stdout:
                line = line.replace(str(folder), str(options.out))  # where it will be
                progress.clear()
                print(line, end="", flush=True)
                lines.append(line)
            listener.join()
    code = interrupts.exit_status() if process.returncode < 0 and interrupts.number else process.returncode
    check_end(code, said, folder)
    (folder / "procedure" / "table.txt").write_text("".join(lines), encoding="utf-8")
    return code


def hear(line, said, progress):
    """A line of dbs's stderr: an event, or a sentence of the system's."""
    try:
        event = json.loads(line)
    except ValueError:
        said.append(line.strip())
        return
    if event["event"] == "error":
        said.append(event["message"])
    else:
        progress.event_of_dbs(event)


def check_end(code, said, folder):
    """Something was done, and left."""
    done = (folder / "procedure" / "stages.json").exists()
    if interrupts.number and not done:
        raise KeyboardInterrupt
    if code not in (0, 2) and not interrupts.number:
        raise Problem(f"the procedure cannot be done: {' '.join(said) or 'dbs ended early'}")
    if not done:
        raise Problem("the procedure left no files: leave --no-files, --plan and --help out of the options "
                      "after --")
