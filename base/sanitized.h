#pragma once

namespace rubble {

/// Whether AddressSanitizer is compiled in: it watches over what operator new hands out, and holds freed memory back.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kAddressSanitizer = true;
#elif defined(__has_feature)
constexpr bool kAddressSanitizer = __has_feature(address_sanitizer);
#else
constexpr bool kAddressSanitizer = false;
#endif

}  // namespace rubble
