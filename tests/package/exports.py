"""exports.py LIBRARY HEADERS: the shared library exports what the public headers mark PELLUCID_API, and nothing else.

Templates of other libraries that those libraries export themselves are left alone."""
import re
import subprocess
import sys
from pathlib import Path

library, headers = sys.argv[1], Path(sys.argv[2])
text = "\n".join(path.read_text() for path in sorted(headers.glob("*.h")) if path.name != "api.h")

marked = set(re.findall(r"\bclass PELLUCID_API (\w+)", text))
marked |= set(re.findall(r"PELLUCID_API (?!class)[^;(]*?(\w+)\(", text))
unmarked = re.findall(r"^(?!PELLUCID_API|inline|constexpr|template|using|//|#|\s)[^;={}\n]*?(\w+)\(", text, re.MULTILINE)

symbols = subprocess.run(["nm", "-DC", "--defined-only", library], check=True, capture_output=True, text=True).stdout
exported, others = set(), set()
for line in symbols.splitlines():
    _, kind, name = line.split(" ", 2)
    if name.startswith("__"):  # the compiler's own, of sanitizers
        continue
    own = re.match(r"(?:(?:typeinfo|typeinfo name|vtable) for )?pellucid::([\w:~]+)", name)
    words = set(own.group(1).split("::")) if own else set()
    exported |= words
    if (own and not words & marked) or (not own and kind not in "WVu"):
        others.add(name)

offences = [f"{name} is declared without PELLUCID_API" for name in unmarked]
offences += [f"{name} is marked PELLUCID_API, but not exported" for name in sorted(marked - exported)]
offences += [f"{name} is exported, but not public" for name in sorted(others)]
print("\n".join(offences) or f"{len(marked)} names are exported, and nothing else")
sys.exit(1 if offences else 0)
