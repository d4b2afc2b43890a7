"""What ping prints; each in the form in which its program does."""

LINUX = """\
PING 192.0.2.7 (192.0.2.7) 56(84) bytes of data.
[1700000000.000100] 64 bytes from 192.0.2.7: icmp_seq=1 ttl=57 time=10.0 ms
[1700000000.200100] 64 bytes from 192.0.2.7: icmp_seq=2 ttl=57 time=14.0 ms
[1700000000.400000] no answer yet for icmp_seq=3
[1700000000.600100] 64 bytes from 192.0.2.7: icmp_seq=4 ttl=57 time=12 ms
[1700000000.600200] 64 bytes from 192.0.2.7: icmp_seq=4 ttl=57 time=13 ms (DUP!)

--- 192.0.2.7 ping statistics ---
5 packets transmitted, 3 received, +1 duplicates, 40% packet loss, time 803ms
rtt min/avg/max/mdev = 10.0/12.0/14.0/1.6 ms
"""
MACOS = """\
PING example.net (192.0.2.7): 56 data bytes
64 bytes from 192.0.2.7: icmp_seq=0 ttl=57 time=10.000 ms
64 bytes from 192.0.2.7: icmp_seq=1 ttl=57 time=14.000 ms
Request timeout for icmp_seq 2
64 bytes from 192.0.2.7: icmp_seq=3 ttl=57 time=12.000 ms

--- example.net ping statistics ---
5 packets transmitted, 3 packets received, 40.0% packet loss
"""
BUSYBOX = """\
64 bytes from 192.0.2.7: seq=0 ttl=57 time=10.000 ms
64 bytes from 192.0.2.7: seq=1 ttl=57 time=14.000 ms
64 bytes from 192.0.2.7: seq=3 ttl=57 time=12.000 ms
5 packets transmitted, 3 packets received, 40% packet loss
"""
WINDOWS = """\
Pinging 192.0.2.7 with 32 bytes of data:
Reply from 192.0.2.7: bytes=32 time=10ms TTL=57
Reply from 192.0.2.7: bytes=32 time=14ms TTL=57
Request timed out.
Reply from 192.0.2.7: bytes=32 time=12ms TTL=57
Request timed out.
"""


def pings(*numbers: int) -> str:
    return "".join(f"64 bytes from x: icmp_seq={k % 65536} ttl=5 time=1 ms\n" for k in numbers)
