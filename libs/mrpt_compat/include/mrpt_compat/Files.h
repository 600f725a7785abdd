#pragma once
#include <mrpt_compat/Release.h>

#if MSO_MRPT_AT_LEAST(3, 0, 0)
#include <mrpt/io/CCompressedInputStream.h>
#else
#include <mrpt/io/CFileGZInputStream.h>
#endif

namespace mrpt_compat {

/** Reads files as this MRPT compresses them: with gzip, since MRPT 3 with Zstandard, too. */
#if MSO_MRPT_AT_LEAST(3, 0, 0)
using CompressedInput = mrpt::io::CCompressedInputStream;
#else
using CompressedInput = mrpt::io::CFileGZInputStream;
#endif

}  // namespace mrpt_compat
