"""What the scripts that run inside Blender share."""
import os
import sys
import traceback


def leave_after(main):
    """Runs main(the first argument after "--") and ends the process with its success; Blender itself would leave with 0 after an exception of a script."""
    try:
        main(sys.argv[sys.argv.index("--") + 1])
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)
    sys.stdout.flush()
    os._exit(0)
