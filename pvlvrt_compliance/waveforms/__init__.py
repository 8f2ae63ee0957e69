"""Waveforms: the container that everything downstream judges, and its file formats."""

from pvlvrt_compliance.waveforms.container import Segment, Waveforms

__all__ = ["Segment", "Waveforms"]
