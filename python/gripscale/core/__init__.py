"""Ground floor: errors, checks, units, versions and threads."""
