using System;
using System.Runtime.InteropServices;

namespace Crumble {

/// <summary>The native library: finding it, its version, and what it says of itself.</summary>
/// <remarks>It is looked for once, before the first call: the file that the environment variable CRUMBLE_LIBRARY names,
/// else libcrumble.so.0.1 (crumble.dll, libcrumble.0.1.dylib) where the system looks. In Unity it is the plugin called
/// crumble.</remarks>
public static unsafe partial class Library {
  static readonly object Gate = new object();
  static volatile bool ready;
  static string sought = "crumble";
#if !UNITY_5_3_OR_NEWER
  static bool mapped;
#endif

  /// <summary>"major.minor.patch".</summary>
  public static string Version { get { Require(); return Text.From(Native.crumble_version_string()); } }
  /// <summary>One line for bug reports: version, source revision, compiler, kernels.</summary>
  public static string BuildInfo { get { Require(); return Text.From(Native.crumble_build_info()); } }
  /// <summary>The kernel with this number, slowest first; null when there are no more.</summary>
  public static string KernelName(uint index) {
    Require();
    return Text.From(Native.crumble_kernel_name(index));
  }

  /// <summary>What the library has taken and not given back.</summary>
  public static MemoryInfo GetMemoryInfo() {
    Require();
    var info = new MemoryInfo { StructSize = (uint)sizeof(MemoryInfo) };
    Check(Native.crumble_memory_get_info(&info));
    return info;
  }

  /// <summary>Finds the library and checks its version; afterwards it does nothing. To be called by all that may be a
  /// program's first call.</summary>
  internal static void Require() {
    if (ready) return;
    lock (Gate) {
      if (ready) return;
      Find();
      CheckVersion();
      ready = true;
    }
  }

  internal static void Check(int result) {
    if (result != 0) throw CrumbleException.Last(result);
  }

  static void Find() {
#if !UNITY_5_3_OR_NEWER
    if (mapped) return;
    string named = Environment.GetEnvironmentVariable("CRUMBLE_LIBRARY");
    sought = string.IsNullOrEmpty(named) ? SystemName() : named;
#if NETCOREAPP3_0_OR_GREATER
    NativeLibrary.SetDllImportResolver(typeof(Native).Assembly, (name, assembly, path) =>
        name == "crumble" ? NativeLibrary.Load(sought) : IntPtr.Zero);
#else
    if (Type.GetType("Mono.Runtime") != null) mono_dllmap_insert(null, "crumble", null, sought, null);
#endif
    mapped = true;
#endif
  }

#if !UNITY_5_3_OR_NEWER
  static string SystemName() {
    if (RuntimeInformation.IsOSPlatform(OSPlatform.Windows)) return "crumble.dll";
    return RuntimeInformation.IsOSPlatform(OSPlatform.OSX) ? "libcrumble.0.1.dylib" : "libcrumble.so.0.1";
  }

#if !NETCOREAPP3_0_OR_GREATER
  // what a dllmap in a .config file does, at run time
  [DllImport("__Internal")]
  static extern void mono_dllmap_insert(string assembly, string dll, string function, string target, string name);
#endif
#endif

  static void CheckVersion() {
    try {
      Check(Native.crumble_check_version(Native.Version));
    } catch (DllNotFoundException error) {
      throw new DllNotFoundException("crumble: cannot load " + sought + " (the environment variable CRUMBLE_LIBRARY " +
                                     "names another file): " + error.Message, error);
    } catch (EntryPointNotFoundException error) {
      throw new DllNotFoundException("crumble: " + sought + " is not the crumble library: " + error.Message, error);
    }
  }
}

}
