"""Where the tests of a job are run: in this process, in others, on other machines."""
