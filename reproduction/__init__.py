"""The figures of Lind & Wangenheim 2014 (IMECE2014-37998) with real and named inputs.

Run as `python -m reproduction [fig5a ...] --output DIR` from the source of gripscale.
"""
