"""What lies below the measurement."""
