"""Marked numbers under the name that checks of other packages import; their home is `pvlvrt_compliance.data.marks`."""

from pvlvrt_compliance.data.marks import (
    CHOSEN,
    CONFIDENCES,
    VERIFIED,
    Choice,
    Confidence,
    Flag,
    Fraction,
    Marked,
    NotNegative,
    Number,
    Numbers,
    Positive,
    marks_in,
    weakest,
)

__all__ = ["CHOSEN", "CONFIDENCES", "VERIFIED", "Choice", "Confidence", "Flag", "Fraction", "Marked", "NotNegative"]
__all__ += ["Number", "Numbers", "Positive", "marks_in", "weakest"]
