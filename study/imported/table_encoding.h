#pragma once
// The bytes of a table as UTF-8, whatever program saved them.

#include <string>

namespace study {

struct DecodedText {
    std::string text; ///< UTF-8 without a byte-order mark
    std::string note; ///< how it was read, if that is not certain; empty = as UTF-8 or by its byte-order mark
};

/// UTF-8; UTF-16 of either byte order, with a byte-order mark or by the zero bytes of its ASCII characters; other bytes as
/// Windows-1252, of which Latin-1 is a part.
/// @throws ScriptError zero bytes, UTF-16 that ends within a character or has lone surrogates, UTF-8 that is broken in
/// single places, bytes that Windows-1252 does not have
DecodedText decoded_table(std::string bytes, std::string const& file);

} // namespace study
