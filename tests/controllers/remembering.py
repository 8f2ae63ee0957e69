"""Controllers that give a little less with time, and keep that time in one place or another."""

from pathlib import Path

from pvlvrt_compliance.controllers.templates.python.controller import Controller

SAMPLES = [0]


class Remembering(Controller):
    """Counts its samples in itself; from the 12 000th on it gives a little less."""

    def __init__(self, log=""):
        super().__init__()
        self.log = log

    def reset(self, nominal):
        """Begin to count."""
        super().reset(nominal)
        self.count = 0

    def counted(self):
        """Samples so far."""
        self.count += 1
        return self.count

    def step(self, y):
        """Command what the template does, or a little less."""
        if self.log:
            with Path(self.log).open("a") as file:
                file.write(".")
        gain = 1.0 if self.counted() < 12_000 else 0.999
        return tuple(gain * m for m in super().step(y))

    def signals(self):
        """What is recorded."""
        return super().signals() | {"count": self.count}


class InItsModule(Remembering):
    """Counts them in its module."""

    def counted(self):
        """Samples so far."""
        SAMPLES[0] += 1
        self.count = 0
        return SAMPLES[0]


class WithAFunction(Remembering):
    """Has what cannot be pickled."""

    def reset(self, nominal):
        """Begin to count."""
        super().reset(nominal)
        self.gain = lambda x: x


class Failing(Remembering):
    """Fails in the sag."""

    def step(self, y):
        """Command the same."""
        if self.count > 15_000:
            raise ValueError("no more than 15 000")
        return super().step(y)
