"""`python -m gripscale` is the command `gripscale`."""

from gripscale.cli import main

if __name__ == "__main__":
    main()
