"""What the scripts with pyigtl share."""
import sys


def import_from(folder):
    sys.path.insert(0, folder)


def expect(good, what):
    if not good:
        sys.exit(f"pyigtl: {what}")
