"""The C header made from the table of variables."""

import math
from collections.abc import Mapping, Sequence

from laglab_fmu.models import Kind, Role, Variable

_C_TYPE = {
    Kind.FLOAT64: "TYPE_FLOAT64",
    Kind.INT32: "TYPE_INT32",
    Kind.UINT64: "TYPE_UINT64",
    Kind.BOOLEAN: "TYPE_BOOLEAN",
    Kind.ENUMERATION: "TYPE_INT64",
}

_C_ROLE = {
    Role.TIME: "ROLE_TIME",
    Role.ROBOTS: "ROLE_ROBOTS",
    Role.PARAMETER: "ROLE_PARAMETER",
    Role.TUNABLE: "ROLE_TUNABLE",
    Role.INPUT: "ROLE_INPUT",
    Role.DERIVATIVE: "ROLE_DERIVATIVE",
}

_TEMPLATE = """\
/* Made from the table of variables; do not edit. */
#ifndef LAGLAB_VARIABLES_H
#define LAGLAB_VARIABLES_H

#include <math.h>

#include "instance.h"

{tokens}

enum {{
{references}
    VARIABLES
}};

static const Variable VARIABLE[VARIABLES] = {{
{lines}
}};

#endif
"""


def variables_header(variables: Sequence[Variable], tokens: Mapping[str, str]) -> str:
    """The text of `variables.h`: tokens, value references, what C needs of each variable."""
    return _TEMPLATE.format(
        tokens="\n".join(f'#define {name} "{text}"' for name, text in tokens.items()),
        references="\n".join(f"    {_constant(variable)}," for variable in variables),
        lines="\n".join(_line(variable) for variable in variables),
    )


def _constant(variable: Variable) -> str:
    return f"VR_{variable.field.upper()}"


def _line(variable: Variable) -> str:
    in_robot = variable.role not in (Role.TIME, Role.ROBOTS)
    cells = (
        f'"{variable.name}"',
        _C_TYPE[variable.kind],
        _C_ROLE.get(variable.role, "ROLE_OUTPUT"),
        f"offsetof(Robot, {variable.field})" if in_robot else "0",
        _number(variable.minimum, -math.inf),
        _number(variable.maximum, math.inf),
        repr(float(variable.start)),
    )
    return "    {" + ", ".join(cells) + "},"


def _number(value: float | None, default: float) -> str:
    number = default if value is None else float(value)
    return repr(number) if math.isfinite(number) else ("-" if number < 0 else "") + "INFINITY"
