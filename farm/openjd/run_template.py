#!/usr/bin/env python3
# farm/openjd/run_template.py - checks an Open Job Description template and runs it on this machine.
# SPDX-License-Identifier: Apache-2.0
"""run_template.py TEMPLATE.yaml NAME=VALUE...

Checks the template against job_template.schema.json and the rules that a schema cannot tell, then
runs its steps: every task in turn, as the specification says (jobtemplate-2023-09). Of each task
it prints the last percentage of openjd_progress. For tests: a farm has its own worker agent, and
`openjd run` of the package openjd-cli does more.
"""
import json
import os
import re
import subprocess
import sys
import tempfile

import jsonschema
import yaml


def refuse(text):
    sys.exit(f"run_template.py: {text}")


def read_template(path):
    with open(path, encoding="utf-8") as file:
        template = yaml.safe_load(file)
    schema_path = os.path.join(os.path.dirname(os.path.abspath(__file__)),
                               "job_template.schema.json")
    with open(schema_path, encoding="utf-8") as file:
        validator = jsonschema.Draft202012Validator(json.load(file))
    for error in validator.iter_errors(template):
        refuse(f"{path}: {error.json_path}: {error.message}")
    return template


def resolve(text, values):
    """Replaces {{Name}} by its value; a name that is not in scope is refused."""

    def value_of(match):
        name = match.group(1).strip()
        if name not in values:
            refuse(f"{{{{{name}}}}} is not in scope in {text!r}")
        return str(values[name])

    return re.sub(r"\{\{(.*?)\}\}", value_of, text)


def job_values(template, given):
    """Param.* and RawParam.*, checked as the definitions say; the paths among Param.*, which
    scripts alone may use, apart."""
    values, paths = {}, {}
    for definition in template.get("parameterDefinitions", []):
        name = definition["name"]
        if name not in given and "default" not in definition:
            refuse(f"parameter {name} has no value")
        value = given.pop(name, definition.get("default"))
        if definition["type"] == "INT":
            value = int(value)
            if not definition.get("minValue", value) <= value <= definition.get("maxValue", value):
                refuse(f"parameter {name}: {value} is out of range")
        values["RawParam." + name] = value
        if definition["type"] == "PATH":
            paths["Param." + name] = os.path.abspath(value)
        else:
            values["Param." + name] = value
    if given:
        refuse(f"there is no parameter {next(iter(given))}")
    return values, paths


def numbers_of(range_text):
    """The numbers of an IntRangeExpr: 1-5, 1-9:2, 3,7."""
    numbers = set()
    for element in range_text.split(","):
        match = re.fullmatch(r"\s*(-?\d+)(?:\s*-\s*(-?\d+)(?::(-?\d+))?)?\s*", element)
        if match is None:
            refuse(f"{element!r} is no range")
        first, last, step = match.groups()
        last, step = int(last or first), int(step or 1)
        numbers |= set(range(int(first), last + (1 if step > 0 else -1), step))
    return sorted(numbers)


def tasks_of(step, values):
    """The values of Task.Param.* of every task: all combinations."""
    tasks = [{}]
    for parameter in step.get("parameterSpace", {}).get("taskParameterDefinitions", []):
        numbers = parameter["range"]
        if isinstance(numbers, str):
            numbers = numbers_of(resolve(numbers, values))
        tasks = [{**task, "Task.Param." + parameter["name"]: number}
                 for task in tasks for number in numbers]
    return tasks


def run_task(step, values, folder):
    script = step["script"]
    files = script.get("embeddedFiles", [])
    for file in files:
        values["Task.File." + file["name"]] = os.path.join(folder, file.get("filename",
                                                                            file["name"]))
    for file in files:
        path = values["Task.File." + file["name"]]
        if os.path.exists(path):
            os.chmod(path, 0o600)
        with open(path, "w", encoding="utf-8") as out:
            out.write(resolve(file["data"], values))
        os.chmod(path, 0o500 if file.get("runnable") else 0o400)
    action = script["actions"]["onRun"]
    command = [resolve(word, values) for word in [action["command"], *action.get("args", [])]]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          timeout=action.get("timeout"), check=False)
    told = re.findall(r"^openjd_progress: (\d+(?:\.\d+)?)$", done.stdout, re.MULTILINE)
    if done.returncode != 0:
        why = re.findall(r"^openjd_fail: (.*)$", done.stdout, re.MULTILINE)
        refuse(f"{step['name']}: exit code {done.returncode}: {' '.join(why) or done.stdout}")
    return told[-1] if told else "no"


def main():
    if len(sys.argv) < 2:
        refuse(__doc__)
    template = read_template(sys.argv[1])
    values, paths = job_values(template, dict(word.split("=", 1) for word in sys.argv[2:]))
    names = [step["name"] for step in template["steps"]]
    if len(set(names)) != len(names):
        refuse("two steps have one name")
    print(resolve(template["name"], values))
    finished = set()
    with tempfile.TemporaryDirectory() as folder:
        for step in template["steps"]:
            for dependency in step.get("dependencies", []):
                if dependency["dependsOn"] not in finished:
                    refuse(f"{step['name']} depends on {dependency['dependsOn']}, which is not run "
                           "before it")
            for task in tasks_of(step, values):
                progress = run_task(step, {**values, **paths, **task}, folder)
                print(f"{step['name']} {task}: progress {progress} %")
            finished.add(step["name"])


if __name__ == "__main__":
    main()
