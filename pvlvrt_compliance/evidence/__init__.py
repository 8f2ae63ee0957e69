"""What a check sees of one record: windows, series measured once each, excursions, frequency; never the simulator."""
