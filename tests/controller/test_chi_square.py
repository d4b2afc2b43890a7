"""The chi-square distribution beside SciPy's."""

import pytest
from scipy.stats import chi2

from laglab_control.chi_square import chi_square_bound, chi_square_tail


@pytest.mark.parametrize("degrees", [1, 2, 3, 4, 9, 75, 600, 3000])
def test_the_bound_is_scipys(degrees: int) -> None:
    for tail in (1e-9, 1e-6, 0.025, 0.5, 0.975):
        bound = chi_square_bound(tail, degrees)
        assert bound == pytest.approx(float(chi2.isf(tail, degrees)), rel=1e-9)
        assert chi_square_tail(bound, degrees) == pytest.approx(tail, rel=1e-6)


def test_it_is_never_negative() -> None:
    assert chi_square_tail(-1.0, 3) == 1.0
    assert chi_square_tail(0.0, 3) == 1.0
