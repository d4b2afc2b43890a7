"""Frames made by hand: right ones that are unusual, and wrong ones."""

from dataclasses import dataclass, replace
from typing import Self

from fastcrc import crc16
from msgspec.structs import astuple

from laglab_protocol import SIGNED, START, Message, Signer, layout_of


@dataclass(frozen=True)
class Forged:
    """A frame whose every part can be replaced; `raw` is what travels."""

    payload: bytes
    message_id: int
    crc_extra: bytes
    system: int
    component: int
    sequence: int
    incompatibility: int = 0
    compatibility: int = 0
    crc_flip: int = 0
    signer: Signer | None = None

    @classmethod
    def of(
        cls, message: Message, system: int, component: int, sequence: int, signer: Signer | None
    ) -> Self:
        """The usual frame of `message`, signed if there is a signer."""
        layout = layout_of(message)
        whole = layout.pack(*astuple(message))
        payload = whole.rstrip(b"\0") or b"\0"
        flags = SIGNED if signer else 0
        return cls(
            payload,
            layout.id,
            layout.crc_extra,
            system,
            component,
            sequence,
            flags,
            signer=signer,
        )

    def untrimmed(self, message: Message) -> Self:
        """With all the zeros that might have stayed at home."""
        return replace(self, payload=self.payload.ljust(layout_of(message).size, b"\0"))

    @property
    def raw(self) -> bytes:
        header = bytes(
            [
                START,
                len(self.payload),
                self.incompatibility,
                self.compatibility,
                self.sequence,
                self.system,
                self.component,
                *self.message_id.to_bytes(3, "little"),
            ]
        )
        body = header + self.payload
        crc = crc16.mcrf4xx(body[1:] + self.crc_extra) ^ self.crc_flip
        return self.signer.sign(body, crc) if self.signer else body + crc.to_bytes(2, "little")
