"""Which strain softens the rubber on a scale: the half-space against blocks of rubber."""
