"""What the scripts with pymodbus share."""
import sys


def import_from(folder):
    sys.path.insert(0, folder)


def expect(good, what):
    if not good:
        sys.exit(f"pymodbus: {what}")
