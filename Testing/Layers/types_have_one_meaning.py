#!/usr/bin/env python3
"""Finds types that one program has two of under one name.

    types_have_one_meaning.py PROGRAM...

A PROGRAM is a list of files and folders with a comma between them, those of one program and its libraries. C++ has one
definition of a name in a program: where two files define another `tyndall::VoxelBox` each, the linker takes one
constructor for both, and what it does to the other's memory depends on the optimiser. Neither compiler nor linker says
anything. Types in unnamed namespaces and in functions are a file's own and may be called what they like. What two files
define alike is told as well: it belongs in one header.

Read are the sources, not object files: those of an optimised build hold no types. The preprocessor's conditions are not
followed.
"""
import collections
import os
import re
import sys

TOKEN = re.compile(r'''
    (?P<skip>//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:[^\n\\]|\\.)*)      # comments, the preprocessor's lines
  | (?P<raw>R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)")
  | (?P<text>"(?:[^"\\\n]|\\.)*"|(?<![0-9A-Za-z_])'(?:[^'\\\n]|\\.)*')
  | (?P<word>[A-Za-z_]\w*|::|[{}();<>=,:]|[0-9][0-9A-Za-z_.']*)
''', re.VERBOSE | re.DOTALL | re.MULTILINE)
KINDS = {"struct", "class", "union", "enum"}


def words_of(text):
    return [match["word"] for match in TOKEN.finditer(text) if match["word"]]


def without_templates(words):
    """Without the parameters of templates, whose `class T` defines nothing, and without what is in round brackets."""
    left, depth = [], 0
    for at, word in enumerate(words):
        if depth == 0 and not (word == "<" and at > 0 and words[at - 1] == "template") and word != "(":
            left.append(word)
        elif word in "(<":
            depth += 1
        elif word in ")>":
            depth -= 1
    return left


def scope_of(head):
    """What a brace opens after these words: ("namespace" or "type", name), or None. A namespace may have no name."""
    head = without_templates(head)
    if "namespace" in head:
        return "namespace", "".join(head[head.index("namespace") + 1:])
    kinds = [at for at, word in enumerate(head) if word in KINDS]
    if not kinds or "=" in head:
        return None
    name = head[kinds[-1] + 1:]
    if kinds[-1] > 0 and head[kinds[-1] - 1] == "enum":  # enum class
        kinds.pop()
    if ":" in name:
        name = name[:name.index(":")]
    name = [word for word in name if word != "final"]
    # A word before the name is a macro for export; `struct X f() {` has a bracket's words gone, but two names.
    exported = len(name) == 2 and name[0].isupper()
    full = "".join(name[1:] if exported else name)
    return ("type", full) if full and (exported or len(name) == 1 or "::" in name or "<" in name) else None


def types_of(text):
    """Full names of the types that a file defines for all files to see."""
    scopes, head, found = [], [], set()
    for word in words_of(text):
        if word == "{":
            scope = scope_of(head)
            if scope and scope[0] == "type" and all(s and s[0] == "namespace" and s[1] for s in scopes):
                found.add("::".join([s[1] for s in scopes] + [scope[1]]))
            scopes.append(scope)
            head = []
        elif word == "}":
            if scopes:
                scopes.pop()
            head = []
        elif word == ";":
            head = []
        else:
            head.append(word)
    return found


def files_of(program):
    for place in program.split(","):
        if os.path.isfile(place):
            yield place
        for folder, _, names in os.walk(place):
            yield from (os.path.join(folder, name) for name in sorted(names) if name.endswith((".h", ".cxx")))


def main(programs):
    pairs, count = set(), 0
    for program in programs:
        where = collections.defaultdict(list)
        for file in files_of(program):
            with open(file, encoding="utf-8") as source:
                for name in types_of(source.read()):
                    where[name].append(file)
        count = max(count, len(where))
        pairs |= {(name, tuple(files)) for name, files in where.items() if len(files) > 1}
    for name, files in sorted(pairs):
        print("%s is defined in %s. Give them names of their own, or unnamed namespaces." % (name, " and ".join(files)))
    if not count:
        print("There are no types in " + " ".join(programs))
    return 1 if pairs or not count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
