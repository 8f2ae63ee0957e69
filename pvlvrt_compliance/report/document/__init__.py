"""What a report says, apart from how it is set: pure functions of results and texts, for page and PDF alike."""
