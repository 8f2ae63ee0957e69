"""One model of panels, lines and areas, made from evidence or from a profile; one file a drawer."""

OF_A_TEST = f"{__name__}.of_test:drawing"
"""What draws a judged record, by its name: `(evidence, result, *, buckets) -> Drawing`."""

OF_A_RECORD = f"{__name__}.of_record:made"
"""What makes of a judged record all that reports show of it: `(evidence, result, *, buckets, language, forms)`."""
