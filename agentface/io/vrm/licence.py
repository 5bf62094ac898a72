"""What VRM's licence fields say of a face: from its provenance, and no more than that allows.

Source: VRM Consortium, VRMC_vrm-1.0, meta.md. What the licences do not speak of (violence, politics, ...) is left out,
which to VRM means that it is not allowed.
"""

from __future__ import annotations

from typing import Any

from agentface.head.provenance import Provenance

_LICENCE = "https://vrm.dev/licenses/1.0/"
_UNKNOWN = "not stated"


def meta_of(name: str, version: str, provenance: Provenance, thumbnail: int) -> dict[str, Any]:
    """The field ``meta`` of an avatar; ``thumbnail`` is the number of its image."""
    free = provenance.permissive
    origins = provenance.origins
    return {
        "name": name,
        "version": version,
        "authors": list(dict.fromkeys(origin.source for origin in origins)) or [_UNKNOWN],
        "copyrightInformation": provenance.copyright_line,
        "thirdPartyLicenses": "\n".join(f"{origin.what}: {origin.licence}" for origin in origins) or _UNKNOWN,
        "thumbnailImage": thumbnail,
        "licenseUrl": _LICENCE,
        "avatarPermission": "everyone" if free else "onlyAuthor",
        "commercialUsage": "corporation" if free else "personalNonProfit",
        "creditNotation": "required" if provenance.needs_credit else "unnecessary",
        "allowRedistribution": free,
        "modification": "allowModificationRedistribution" if free else "prohibited",
    }
