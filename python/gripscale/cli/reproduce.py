"""x"""
def reproduce() -> None:
    """Reproduce figures of Lind & Wangenheim 2014 and judge the paper's statements."""
