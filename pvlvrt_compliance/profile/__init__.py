"""Grid codes as data: the model, the files, where every number comes from."""
