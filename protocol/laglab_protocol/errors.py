"""What can go wrong here, as one tree. Bytes from the link never raise: they are counted."""


class ProtocolError(Exception):
    """Any error of this component."""


class DialectError(ProtocolError):
    """The dialect file, or a message, is not as it must be."""


class EndpointError(ProtocolError):
    """An endpoint cannot be opened or used."""


class BadUrlError(EndpointError):
    """The endpoint's spelling is wrong; the message names the part."""


class NoSuchPortError(EndpointError):
    """The port or address does not exist here, or may not be used."""


class PortBusyError(EndpointError):
    """Something else holds the port, address or path."""


class FarEndGoneError(EndpointError):
    """The device went away under us."""


class FarEndStalledError(EndpointError):
    """The far end no longer reads, and what waits for it fills the queue."""


class SettingsError(ProtocolError):
    """The two sides were told things that do not go together."""


class KeyFileError(ProtocolError):
    """The signing key, or the timestamps kept with it, cannot be used."""


class UnsignedLinkError(ProtocolError):
    """An endpoint that strangers can reach, and no key."""


class TlogError(ProtocolError):
    """The file is no telemetry log."""
