"""A page for each shipped profile, and the facts on the page of each check, from profiles and checks themselves."""
