"""What lies between plant and controller: sensors, converters, delays, precision."""
