"""The robots that ship, each by its table of variables."""

from laglab_fmu.models.shipped import MODELS, ROBOT, Model, model_named, model_of, token
from laglab_fmu.models.variables import Kind, Role, Variable

__all__ = [
    "MODELS",
    "ROBOT",
    "Kind",
    "Model",
    "Role",
    "Variable",
    "model_named",
    "model_of",
    "token",
]
