#pragma once
#if __has_include(<mrpt/io/CCompressedInputStream.h>)
#include <mrpt/io/CCompressedInputStream.h>
#else
#include <mrpt/io/CFileGZInputStream.h>
#endif

/** Reads files as this MRPT compresses them: with gzip, in later releases with Zstandard, too. */
#if __has_include(<mrpt/io/CCompressedInputStream.h>)
using CompressedInput = mrpt::io::CCompressedInputStream;
#else
using CompressedInput = mrpt::io::CFileGZInputStream;
#endif
