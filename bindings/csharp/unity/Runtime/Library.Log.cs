using System;

namespace Crumble {

public static unsafe partial class Library {
  // native code knows this one as long as the program runs; what it calls may change
  static readonly LogFunction LogCall = OnLog;
  static readonly object LogGate = new object();
  static volatile Action<LogLevel, string> log;
  static bool unloadWatched;

  /// <summary>What a function given to SetLog threw last, which cannot pass through the library; null before.</summary>
  public static Exception LogFailure { get; private set; }

  /// <summary>What the library has to say goes to `function` from here on, a line each time; null: nowhere.</summary>
  /// <remarks>It is called in the thread that makes the call it tells of, before that returns, and never in a step, a tick,
  /// or a read or write of a device. It may use the library. Finalizers are such threads too.</remarks>
  public static void SetLog(Action<LogLevel, string> function) {
    Require();
    lock (LogGate) {
      log = function;
      if (!unloadWatched) AppDomain.CurrentDomain.DomainUnload += OnUnload;
      unloadWatched = true;
      Check(Native.crumble_log_set(function == null ? null : LogCall, null));
    }
  }

  // A domain that goes, as Unity's editor reloads one, takes OnLog along; the library stays.
  static void OnUnload(object sender, EventArgs about) {
    if (log != null) SetLog(null);
  }

  [MonoPInvokeCallback(typeof(LogFunction))]
  static void OnLog(uint level, byte* text, IntPtr user) {
    Action<LogLevel, string> function = log; // may just have been taken away
    try {
      if (function != null) function((LogLevel)level, Text.From(text));
    } catch (Exception error) { LogFailure = error; }
  }
}

}
