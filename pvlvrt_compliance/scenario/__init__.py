"""What happens to the plant: sags, grid strength, irradiance. No simulation code here."""
