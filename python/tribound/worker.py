"""A run of a sweep in a process of its own: reads the task from stdin, ends with the exit code of the program."""

import pickle
import sys

from tribound.sweep import solve

if __name__ == "__main__":
    sys.exit(solve(*pickle.load(sys.stdin.buffer)))
