"""What pages are made with: their templates, and the section of a test, which is made where its record is."""
