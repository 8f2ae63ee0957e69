"""What standards measure, from waveforms alone."""
