"""One file a format, each `render(results)`."""
