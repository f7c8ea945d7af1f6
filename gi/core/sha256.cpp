#include "gi/core/sha256.h"

#include <nettle/sha2.h>

namespace gi {

std::string sha256(std::string_view bytes)
{
    sha256_ctx context;
    sha256_init(&context);
    sha256_update(&context, bytes.size(), reinterpret_cast<std::uint8_t const*>(bytes.data()));
    std::uint8_t digest[SHA256_DIGEST_SIZE];
    sha256_digest(&context, sizeof digest, digest);
    std::string text;
    for (std::uint8_t const byte : digest)
        for (int const digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
    return text;
}

} // namespace gi
