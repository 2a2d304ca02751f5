"""The chain in several variants against the direct contact of the same surfaces."""
