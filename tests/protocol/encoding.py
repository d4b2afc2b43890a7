"""One frame, as a sender makes it when its count has come so far."""

from laglab_protocol import Message, Sender


def encode(message: Message, system: int, component: int, sequence: int) -> bytes:
    sender = Sender(system, component)
    for _ in range(sequence):
        sender.frame(message)
    return sender.frame(message)
