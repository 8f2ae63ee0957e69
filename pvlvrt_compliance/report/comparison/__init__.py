"""Two runs beside each other, a file a format, each `render(comparison, ...)` of the one comparison."""
