# cmake -DSOURCE=... -DOUT=... -DVERSION=... -P git_hash.cmake: a header that changes only when the commit does.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --exclude=* OUTPUT_VARIABLE hash
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT hash)
  set(hash unknown)
endif()
file(WRITE ${OUT}.new "#define LIGHTWELL_VERSION \"${VERSION}\"\n#define LIGHTWELL_GIT_HASH \"${hash}\"\n")
execute_process(COMMAND ${CMAKE_COMMAND} -E copy_if_different ${OUT}.new ${OUT})
