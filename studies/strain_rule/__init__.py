"""Which strain softens the rubber on a scale: the rule of the half-space against blocks of rubber."""
