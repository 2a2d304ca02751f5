"""What went in: surface, rubber, load and conditions as prepared."""
