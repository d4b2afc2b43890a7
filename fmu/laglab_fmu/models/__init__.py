"""The robots that ship, each by its table of variables."""

from laglab_fmu.models.shipped import FLEET_NAME, MODELS, ROBOT, Model, model_of, token
from laglab_fmu.models.variables import Kind, Role, Variable

__all__ = [
    "FLEET_NAME",
    "MODELS",
    "ROBOT",
    "Kind",
    "Model",
    "Role",
    "Variable",
    "model_of",
    "token",
]
