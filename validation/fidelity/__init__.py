"""Averaged and switched inverter side by side: docs/fidelity.md."""
