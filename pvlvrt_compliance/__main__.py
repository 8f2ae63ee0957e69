"""`python -m pvlvrt_compliance`: the command."""

from pvlvrt_compliance.cli.start import main

if __name__ == "__main__":
    main()
