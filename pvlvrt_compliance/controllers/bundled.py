"""The word for the controller that the package brings, where the specification of another one may stand."""

BUNDLED = "bundled"
