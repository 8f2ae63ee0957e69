"""A controller of the user's own, from the command line."""

import pytest

STEADY = """
class Steady:
    sample_time_s = 1e-4
    deed = "nothing"
    power_pu = 1.0
    def reset(self, nominal):
        self.i = [0.0, 0.0, 0.0]
    def step(self, y):
        if self.deed == "raise" and y.u_a_v**2 + y.u_b_v**2 + y.u_c_v**2 < 1e5 and y.time_s > 1.3:
            raise RuntimeError("the sag was too much")
        u = (y.u_a_v, y.u_b_v, y.u_c_v)
        print(y.time_s)
        g = self.power_pu * y.p_set_w / (3 * 230.0**2)
        return [(a + 0.08 * (g * a - b)) / (0.5 * y.v_dc_v) for a, b in zip(u, y[4:7])]
    def signals(self):
        return {"p_ref_w": 1e3}
"""


@pytest.fixture
def controller(tmp_path):
    """Specification of a controller in a file."""
    (tmp_path / "mine.py").write_text(STEADY)
    return f"{tmp_path / 'mine.py'}:Steady"


def test_provenance_says_whose_controller_it_was(judge, controller):
    """Specification, digest, sample time, plant step and delay stand in the results, with the parameters set."""
    ended, reports = judge("--sag", "20%", "--controller", controller, "--set", "controller.power_pu=0.9", "--csv")
    assert ended.status in (0, 1, 3)
    origin = reports.json["provenance"]
    assert origin["controller"] == controller
    assert len(origin["controller_digest"]) == 64
    assert (origin["controller_sample_time_s"], origin["plant_step_us"]) == (1e-4, pytest.approx(5.0))
    assert origin["computation_delay_samples"] == 1
    assert origin["controller_parameters"]["power_pu"] == 0.9
    assert reports.test["measurements"]["controller"] == {
        "v_fault_pu": None,
        "q_ref_kvar": None,
        "p_ref_kw": pytest.approx(1.0),
    }


def test_error_of_a_controller_ends_its_test_only(judge, controller):
    """The test is an error, with reason and time; the status is 3, and the reports are written."""
    ended, reports = judge("--sag", "90%", "--controller", controller, "--set", "controller.deed=raise")
    assert ended.status == 3
    assert reports.test["status"] == "error"
    assert "the sag was too much" in reports.test["checks"][0]["message"]
    assert "at 0.30" in reports.test["checks"][0]["message"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--controller", "absent.py:C"), "--controller absent.py:C: there is no file absent.py"),
        (("--set", "controller.powr=1"), 'no such parameter; did you mean "power_pu"'),
        (("--set", "simulation.plant_step_us=3"), "the nearest are 3.0303 us"),
        (("--set", "controller.power_pu=[1]"), "is not a number, true, false or a word"),
    ],
)
def test_what_cannot_be_opened_is_wrong_usage(judge, controller, arguments, words):
    """Status 2, before anything runs."""
    ended, reports = judge("--sag", "90%", "--controller", controller, *arguments)
    assert ended.status == 2
    assert words in ended.err
    assert not reports.folder.exists()
